// Files dropped anywhere on the page become parts.

import type { Actions } from '../actions';

export function drop(page: HTMLElement, sheet: HTMLElement, actions: Actions) {
  const holdsFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
  page.addEventListener('dragover', (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    sheet.hidden = false;
  });
  page.addEventListener('dragleave', (event) => {
    if (event.relatedTarget === null) sheet.hidden = true;
  });
  page.addEventListener('drop', (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    sheet.hidden = true;
    void actions.addFiles([...(event.dataTransfer?.files ?? [])]);
  });
}
