// The package as its users get it: packed, installed into an empty folder, its types checked, and the examples of
// README.md run there while feet walk.
//
//     node package.mjs UNDERFOOT
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import WebSocket from "ws";
import { root, Site, until } from "./harness.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const source = join(here, "..");
const empty = await mkdtemp(join(tmpdir(), "empty-"));
const run = (program, ...args) => execFileSync(program, args, { cwd: empty, encoding: "utf8" });

/** Packs the package into the empty folder; returns the name of the file. */
async function pack() {
  const [packed] = JSON.parse(run("npm", "pack", source, "--json", "--silent", "--pack-destination", empty));
  const files = packed.files.map(({ path }) => path).sort();
  const sources = (await readdir(join(source, "src"))).map((name) => `src/${name}`);
  assert.deepEqual(files, ["LICENSE-APACHE", "LICENSE-MIT", "README.md", "package.json", ...sources].sort());
  const { dependencies, version } = JSON.parse(await readFile(join(source, "package.json"), "utf8"));
  const workspace = /\[workspace\.package\]\nversion = "(.*)"/.exec(await readFile(join(root, "Cargo.toml"), "utf8"));
  assert.deepEqual([dependencies, version], [undefined, workspace[1]]);
  console.log(`${packed.filename}: ${packed.size} bytes, ${files.length} files`);
  return packed.filename;
}

/** `index.d.ts` describes the members of a floor that there are. */
async function members() {
  const { Floor } = await import("../src/floor.js");
  globalThis.WebSocket = class { close() {} };
  const floor = new Floor("127.0.0.1:1");
  const there = new Set([...Object.getOwnPropertyNames(Floor.prototype), ...Object.keys(floor)]);
  there.delete("constructor");
  floor.close();
  const types = await readFile(join(source, "src/index.d.ts"), "utf8");
  const [, body] = /export interface Floor \{\n(.*?)\n\}/s.exec(types);
  const described = new Set([...body.matchAll(/^  (?:readonly )?(\w+)[(:<]/gm)].map(([, name]) => name));
  assert.deepEqual([...described].sort(), [...there].sort());
}

/** The examples of README.md, each with the lines that it prints. */
async function examples() {
  const text = await readFile(join(source, "README.md"), "utf8");
  const found = [...text.matchAll(/```js\n(.*?)```\n\n```text\n(.*?)```/gs)];
  assert.equal(found.length, 3);
  return found.map(([, code, lines]) => ({ code, lines: lines.trim().split("\n") }));
}

/** Runs an example beside the floor at `web`; returns its process and the lines that it has printed. */
async function start({ code }, number, web) {
  const file = join(empty, `example_${number}.mjs`);
  await writeFile(file, code.replaceAll("127.0.0.1:9002", web));
  const printed = [];
  const command = ["--import", join(here, "socket.mjs"), file];
  const process = spawn("node", command, { cwd: empty, stdio: ["ignore", "pipe", "inherit"] });
  process.stdout.setEncoding("utf8").on("data", (text) => printed.push(...text.trim().split("\n")));
  return { process, printed };
}

/** Waits until so many programs are connected to the floor at `web`. */
async function connected(count, web) {
  await until("the web server", () => fetch(`http://${web}/`).catch(() => null));
  const socket = new WebSocket(`ws://${web}/`);
  let there = 0;
  socket.on("message", (text) => { there = JSON.parse(text).connected ?? there; });
  await until(`${count} programs are connected`, () => there > count);
  socket.close();
}

/** Whether these lines were printed, in their order, with or without others between them. */
function has(printed, lines) {
  let next = 0;
  for (const line of printed) if (line === lines[next]) next += 1;
  return next === lines.length;
}

const site = await Site.make(process.argv[2], "map");
const started = [];
try {
  const archive = await pack();
  await writeFile(join(empty, "package.json"), '{ "private": true, "type": "module" }');
  run("npm", "install", "--offline", "--silent", "--no-audit", "--no-fund", `./${archive}`);
  await writeFile(join(empty, "typed.ts"), await readFile(join(here, "typed.ts")));
  const strict = ["--strict", "--exactOptionalPropertyTypes", "--noUncheckedIndexedAccess", "--noEmit"];
  const target = ["--module", "nodenext", "--target", "es2022", "--lib", "es2022,dom", "--types", ""];
  run(join(source, "node_modules/.bin/tsc"), ...strict, ...target, "typed.ts");
  await members();

  site.serve();
  const all = await examples();
  for (const [number, example] of all.entries()) started.push(await start(example, number, site.web));
  await connected(all.length, site.web);
  site.play("bindings/web/tests/visit.ron");
  for (const [number, { lines }] of all.entries()) {
    const { printed } = started[number];
    await until(`example ${number + 1} prints\n${lines.join("\n")}`, () => has(printed, lines), 40).catch((error) => {
      throw new Error(`${error.message}\nbut\n${printed.join("\n")}`);
    });
  }
  console.log(`${all.length} examples of README.md ran beside the feet`);
} finally {
  for (const { process } of started) process.kill();
  await site.end();
  await rm(empty, { recursive: true, force: true });
}
