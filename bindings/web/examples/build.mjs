// Bundles the pages and serves them on port 8000: `npm install && npm start`. `node build.mjs FOLDER` only writes them.
import { writeFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { build, context } from "esbuild";
import { countries } from "./maplibre/countries.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const folder = resolve(process.argv[2] ?? join(here, "built"));
const options = {
  absWorkingDir: here,
  bundle: true,
  format: "esm",
  loader: { ".html": "copy", ".wasm": "copy" },
  logLevel: "warning",
  minify: true,
  outdir: folder,
};

// Its exports do not have the worker.
const loader = "node_modules/@cornerstonejs/dicom-image-loader/dist/esm";

// The decoders of compressed images.
const codecs = "node_modules/@cornerstonejs/codec";
const decoders = [
  ["charls", "charlswasm_decode"],
  ["libjpeg-turbo-8bit", "libjpegturbowasm_decode"],
  ["libjxl", "jpegxlwasm_decode"],
  ["openjpeg", "openjpegwasm_decode"],
  ["openjph", "openjphjs"],
];

// Both libraries look for their worker beside the script of the page, under these names.
await build({
  ...options,
  entryPoints: {
    "maplibre/index": "maplibre/index.html",
    "maplibre/app": "maplibre/app.js",
    "maplibre/maplibre-gl-worker": "maplibre-gl/dist/maplibre-gl-worker.mjs",
  },
  outExtension: { ".js": ".mjs" },
});
await writeFile(join(folder, "maplibre/countries.json"), JSON.stringify(await countries()));
await build({
  ...options,
  entryPoints: {
    "cornerstone/index": "cornerstone/index.html",
    "cornerstone/app": "cornerstone/app.js",
    "cornerstone/decodeImageFrameWorker": `./${loader}/decodeImageFrameWorker.js`,
    ...Object.fromEntries(decoders.map(([codec, name]) => [`cornerstone/${name}`, `./${codecs}-${codec}/dist/${name}.wasm`])),
  },
  // Decoders name these modules of Node, and use them only there.
  external: ["fs", "path"],
});

if (process.argv[2] === undefined) {
  const { port } = await (await context({})).serve({ host: "127.0.0.1", port: 8000, servedir: folder });
  console.log(`http://127.0.0.1:${port}/maplibre/ and http://127.0.0.1:${port}/cornerstone/`);
}
