// The page's build: hashed names, no inline code, no outside address.

import { fileURLToPath } from "node:url";

import { defineConfig } from "vite";

import { fakeService } from "./dev/plugin.js";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  base: "./",
  plugins: [fakeService()],
  server: { host: "127.0.0.1" },
  // The service hands out index.html at its root, and everything else under page/; below a
  // proxy's path both still find each other.
  experimental: {
    renderBuiltUrl: (name, { hostType }) =>
      hostType === "html" ? `page/${name}` : { relative: true },
  },
  build: {
    outDir: here("../src/seacage/service/page"),
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rollupOptions: {
      output: {
        // Told apart, so that a change of ours leaves the libraries in the browser's store.
        manualChunks: (id) =>
          /node_modules\/(three|uplot)/.exec(id.replaceAll("\\", "/"))?.[1],
      },
    },
  },
});
