// The program at work for a test: a floor, simulated feet, and a browser.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

/** The root of the repository. */
export const root = fileURLToPath(new URL("../../../", import.meta.url));

/** Flags of a browser that asks nobody for anything, and draws without a graphics card. */
export const QUIET = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--enable-unsafe-swiftshader",
];

/** The parts of the simulated floor. */
const SEED = "3";

/** An address of this machine whose port was free just before. */
export async function freeAddress() {
  const probe = createServer();
  const port = await listening(probe);
  probe.close();
  return `127.0.0.1:${port}`;
}

async function listening(server) {
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  return server.address().port;
}

/** Waits until `check` gives a value and returns it; an error names `what` after `seconds`. */
export async function until(what, check, seconds = 30) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const found = await check();
    if (found) return found;
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${what}`);
    await new Promise((done) => setTimeout(done, 20));
  }
}

/**
 * `underfoot run` with a web server at `web`, and boards at `boards`. The floor file fits the simulated floor.
 */
export class Site {
  #underfoot;
  #started = [];

  static async make(underfoot, layout) {
    const site = new Site();
    site.#underfoot = resolve(underfoot);
    site.layout = layout;
    site.folder = await mkdtemp(join(tmpdir(), "floor-"));
    [site.web, site.boards] = [await freeAddress(), await freeAddress()];
    // One that sends for a moment to a port that nobody reads.
    const measure = ["--seed", SEED, "--write-floor", "floor.ron", "--seconds", "0.1", "--send", site.boards];
    await once(site.#start("simulate", ...measure), "exit");
    return site;
  }

  #start(...options) {
    const process = spawn(this.#underfoot, options, { cwd: this.folder, stdio: "ignore" });
    this.#started.push(process);
    return process;
  }

  /** Serves the floor, with further options. */
  serve(...options) {
    const usual = ["--floor", "floor.ron", "--listen", this.boards, "--web", this.web, "--no-osc", "--sound", "off"];
    return this.#start("run", this.layout, ...usual, ...options);
  }

  /** Plays a scenario; the file is named from the root of the repository. */
  play(scenario) {
    const visit = ["--seed", SEED, "--scenario", join(root, scenario), "--send", this.boards];
    return this.#start("simulate", this.layout, ...visit);
  }

  async end() {
    for (const process of this.#started) {
      if (process.exitCode !== null || process.signalCode !== null) continue;
      process.kill("SIGKILL");
      await once(process, "exit");
    }
    await rm(this.folder, { recursive: true, force: true });
  }
}

const TYPES = {
  ".css": "text/css",
  ".html": "text/html",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".wasm": "application/wasm",
};

/** Serves the files of a folder; returns the server and its address. */
export async function files(folder) {
  const server = createServer(async (request, answer) => {
    const path = new URL(request.url, "http://localhost").pathname.replace(/\/$/, "/index.html");
    try {
      const content = await readFile(join(folder, path));
      answer.setHeader("Content-Type", TYPES[extname(path)] ?? "application/octet-stream");
      answer.end(content);
    } catch {
      answer.statusCode = 404;
      answer.end();
    }
  });
  return { server, address: `127.0.0.1:${await listening(server)}` };
}
