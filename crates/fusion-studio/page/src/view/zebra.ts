// Stripes of a mirrored environment: where they break, a surface has a crease; where they kink, its curvature jumps.

import { DoubleSide, ShaderMaterial } from 'three';

/** A material of stripes. */
export function zebra(): ShaderMaterial {
  return new ShaderMaterial({
    side: DoubleSide,
    clipping: true,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: `
      #include <clipping_planes_pars_vertex>
      varying vec3 n;
      varying vec3 p;
      void main() {
        #include <begin_vertex>
        #include <project_vertex>
        n = normalMatrix * normal;
        p = mvPosition.xyz;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: `
      #include <clipping_planes_pars_fragment>
      varying vec3 n;
      varying vec3 p;
      void main() {
        #include <clipping_planes_fragment>
        vec3 r = reflect(normalize(p), normalize(gl_FrontFacing ? n : -n));
        float s = sin(24.0 * atan(r.y, length(r.xz)));
        float w = fwidth(s) + 1e-4;
        vec3 light = vec3(0.16 + 0.76 * smoothstep(-w, w, s));
        gl_FragColor = vec4(light, 1.0);
        #include <colorspace_fragment>
      }`,
  });
}
