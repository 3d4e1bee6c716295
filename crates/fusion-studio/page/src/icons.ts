// The page's icons: paths on a grid of 24, stroked in the colour of the text.

const PATHS: { [name: string]: string } = {
  union: 'M9 9m-6 0a6 6 0 1 1 9 5.2A6 6 0 1 1 9 15a6 6 0 0 1-6-6',
  difference: 'M14.5 9.5a6 6 0 1 0-5 5M15 15m-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0M12 12l6 6M10.5 15l4 4',
  intersection: 'M9 9m-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0M15 15m-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0M10 14l4-4M12 15l3-3M9.500 12.500l3-3',
  blend: 'M4 3v8a9 9 0 0 0 9 9h8M13 11m-3.500 0a3.500 3.500 0 1 0 7 0a3.500 3.500 0 1 0-7 0',
  sharpen: 'M4 3v17h17M8 7v9h9', sharp: 'M4 3v17h17',
  compose: 'M3 5c5 0 5 5 9 7s4 7 9 7M3 11c3 0 3 8 9 8M12 5c6 0 6 8 9 8',
  cut: 'M6 7m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0M6 17m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0M8.500 8.700L20 17M8.500 15.300L20 7',
  remesh: 'M12 3l9 16H3zM7.500 11h9M7.500 11l4.500 8l4.500-8',
  repair: 'M15 4a5 5 0 0 0-4.600 6.900L4 17.300V20h2.700l6.400-6.400A5 5 0 0 0 19.500 8l-3 3l-2.500-.500l-.500-2.500z',
  pose: 'M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500',
  detail: 'M3 16c2-6 3 2 5-4s3 4 5-2s3 3 4-2s2 2 4-4M3 20h18',
  cluster: 'M12 3l8 4.500v9L12 21l-8-4.500v-9zM12 12l8-4.500M12 12v9M12 12L4 7.500',
  primitive: 'M5 6a7 2.5 0 0 0 14 0a7 2.5 0 0 0-14 0M5 6v12a7 2.5 0 0 0 14 0V6', part: 'M12 3l8 4.500v9L12 21l-8-4.500v-9zM12 12l8-4.500M12 12v9M12 12L4 7.500', step: 'M5 12h14M13 6l6 6l-6 6',
  new: 'M6 3h8l5 5v13H6zM14 3v5h5', open: 'M3 19V6h6l2 2h8v3M3 19l3-8h16l-3 8z', save: 'M4 4h13l3 3v13H4zM8 4v5h7V4M8 20v-6h8v6',
  export: 'M12 3v12M7 10l5 5l5-5M4 19h16', undo: 'M9 6L4 11l5 5M4 11h10a5 5 0 0 1 0 10h-3', redo: 'M15 6l5 5l-5 5M20 11H10a5 5 0 0 0 0 10h3',
  add: 'M12 5v14M5 12h14', close: 'M6 6l12 12M18 6L6 18', reset: 'M5 12a7 7 0 1 1 2 5M5 12l-2-3M5 12l3-2', remove: 'M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13M10 11v6M14 11v6',
  left: 'M14 6l-6 6l6 6', target: 'M12 12m-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0M12 2v6M12 16v6M2 12h6M16 12h6',
  shown: 'M2 12c5-8 15-8 20 0c-5 8-15 8-20 0M12 12m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0', hidden: 'M3 9c4 6 14 6 18 0M6 13l-2 3M12 14v4M18 13l2 3',
  select: 'M6 3l12 9l-6 1l3 7l-2.500 1l-3-7l-3.500 4z', move: 'M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500',
  rotate: 'M20 12a8 8 0 1 1-3-6M20 3v5h-5', measure: 'M3 16L16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2',
  wire: 'M4 4h16v16H4zM4 4l16 16M12 4v16M4 12h16', edges: 'M4 20c0-9 7-16 16-16M4 20h16M20 4v16', grid: 'M4 4h16v16H4zM4 9.300h16M4 14.700h16M9.300 4v16M14.700 4v16',
  parallel: 'M4 8h10v10H4zM4 8l6-4h10v10l-6 4M14 8l6-4', occlusion: 'M12 12m-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0M17 6.5a8 8 0 0 1-10.500 10.500M15 6a6 6 0 0 1-9 9',
  section: 'M4 8l8-5l8 5v9l-8 4l-8-4zM2 13l20-2', fit: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5', theme: 'M12 4a8 8 0 1 0 0 16zM12 4a8 8 0 0 1 0 16',
  note: 'M12 12m-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0M12 11v5M12 8v.010', warning: 'M12 4l9 16H3zM12 10v4M12 17v.010', error: 'M12 12m-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0M12 7.500v5.500M12 16v.010',
  apply: 'M5 13l4 4L19 7', up: 'M12 20V4M6 10l6-6l6 6', help: 'M12 12m-9 0a9 9 0 1 0 18 0a9 9 0 1 0-18 0M9.500 9.500a2.500 2.500 0 1 1 3.500 2.300c-.700.400-1 .900-1 1.700M12 17v.010',
  picture: 'M3 5h18v14H3zM3 16l5-5l4 4l3-3l6 6M15 9v.010', flip: 'M12 3v18M9 8l-5 4l5 4zM15 8l5 4l-5 4z',
};

/** The icon of a verb; verbs that the page does not know yet have the icon of a step. */
export function verbIcon(verb: string): string {
  return PATHS[verb] ? verb : 'step';
}

/** Puts the icons into the page, to be used by name. */
export function addIcons() {
  const symbols = Object.entries(PATHS).map(([name, d]) => `<symbol id="icon-${name}" viewBox="0 0 24 24"><path d="${d}"/></symbol>`);
  const box = document.createElement('div');
  box.hidden = true;
  box.innerHTML = `<svg xmlns="http://www.w3.org/2000/svg">${symbols.join('')}</svg>`;
  document.body.prepend(box);
}
