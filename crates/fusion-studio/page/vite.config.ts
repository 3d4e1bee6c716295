import { defineConfig } from 'vite';

// The server puts a token before every path, so all addresses in the bundle are relative.
export default defineConfig({
  base: './',
  build: {
    outDir: process.env.FUSION_STUDIO_BUNDLE ?? '../../../target/studio',
    emptyOutDir: true,
    chunkSizeWarningLimit: 1500,
  },
});
