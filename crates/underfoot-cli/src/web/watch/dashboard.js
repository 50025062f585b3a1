"use strict";
// Time between two looks (ms), and longest time for an answer.
const LOOK_EVERY = 1000, PATIENCE = 3000;
const $ = (id) => document.getElementById(id);
// The packets of each board at the last look, and its time (ms).
let before = null;

function cell(text, name) {
  const cell = document.createElement("td");
  cell.textContent = text;
  if (name) cell.className = name;
  return cell;
}

function row(...cells) {
  const row = document.createElement("tr");
  row.append(...cells);
  return row;
}

function item(text) {
  const item = document.createElement("li");
  item.textContent = text;
  return item;
}

function number(name, value) {
  const both = document.createElement("div"), term = document.createElement("dt"), text = document.createElement("dd");
  term.textContent = name;
  text.textContent = value;
  both.append(term, text);
  return both;
}

const grouped = (count) => count.toLocaleString("en").replaceAll(",", "\u202f");

function span(seconds) {
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  if (seconds < 60) return `${Math.floor(seconds)} s`;
  const minutes = Math.floor(seconds / 60), hours = Math.floor(minutes / 60), days = Math.floor(hours / 24);
  if (minutes < 60) return `${minutes} min`;
  if (hours < 48) return `${hours} h ${minutes % 60} min`;
  return `${days} days ${hours % 24} h`;
}

// A name such as too_light, as words.
const words = (name) => name.replaceAll("_", " ");

function showBoards(boards, now) {
  const rate = (board, index) => {
    const old = before?.packets[index];
    return old === undefined ? "" : grouped(Math.round((board.packets - old) / (now - before.at) * 1000));
  };
  $("boards").replaceChildren(...boards.map((board, index) => row(
    cell(index),
    cell(board.address, "wide"),
    cell(board.state, board.state === "live" ? "" : "bad"),
    cell(rate(board, index), "number"),
    cell(`${(board.loss * 100).toFixed(1)} %`, board.loss > 0.1 ? "number bad" : "number"),
    cell(grouped(board.lost), "number"),
    cell(grouped(board.duplicate), "number wide"),
    cell(board.age_s === null ? "never" : board.age_s < 0.1 ? "now" : `${span(board.age_s)} ago`, "number"),
  )));
  before = { at: now, packets: boards.map((board) => board.packets) };
}

function showIgnored(ignored) {
  const counts = Object.entries(ignored.counts).sort((one, other) => other[1] - one[1]);
  $("counts").replaceChildren(...counts.map(([reason, count]) => item(`${words(reason)} ${grouped(count)}`)));
  $("ignored").replaceChildren(...ignored.latest.map((press) => row(
    cell(`${span(press.age_s)} ago`), cell(press.id), cell(press.why), cell(`${Math.round(press.force_n)} N`, "number"),
  )));
  const is_empty = ignored.latest.length === 0;
  $("none").hidden = !is_empty;
  $("ignored").parentElement.hidden = is_empty;
}

function showRows(id, rows) {
  $(id).hidden = rows.length === 0;
  $(id).tBodies[0].replaceChildren(...rows);
}

function showSensors(sensors) {
  const { live, degraded, stale, faulty, uncalibrated } = sensors;
  const parts = [[live, "live"], [degraded, "degraded"], [stale, "silent"], [faulty, "faulty"], [uncalibrated, "not calibrated"]];
  $("sensors").textContent = parts.filter(([count]) => count > 0).map(([count, name]) => `${count} ${name}`).join(", ");
  showRows("troubles", sensors.troubles.map((trouble) => row(
    cell(`column ${trouble.col}, row ${trouble.row}`), cell(trouble.corner.toUpperCase()), cell(words(trouble.trouble)),
  )));
}

function show(floor) {
  document.body.classList.remove("old");
  $("title").textContent = document.title = floor.title || "Floor";
  $("status").textContent = floor.status;
  $("status").className = `badge ${floor.status}`;
  $("uptime").textContent = `link ${floor.link}, up for ${span(floor.uptime_s)}`;
  $("reasons").replaceChildren(...floor.reasons.map(item));
  const live = floor.boards.filter((board) => board.state === "live" || board.state === "degraded").length;
  const numbers = [
    number("boards", `${live} of ${floor.boards.length}`),
    number("feet", floor.feet),
    number("held", floor.held.join(", ") || "nothing"),
    number("frames", grouped(floor.packets.frames)),
    number("packets lost", grouped(floor.packets.lost)),
    number("datagrams refused", grouped(floor.packets.refused)),
    number("floor lost", `${floor.packets.losses} times`),
    number("actuators", floor.device ? floor.device.state : "none"),
    number("reports not sent", grouped(floor.packets.unsent_events)),
    number("clients", `${floor.clients.connected}, ${floor.clients.dropped} dropped`),
  ];
  const { sent, unsent } = floor.targets;
  if (sent + unsent > 0) numbers.push(number("messages to apps", `${grouped(sent)}, ${grouped(unsent)} failed`));
  $("numbers").replaceChildren(...numbers);
  showBoards(floor.boards, performance.now());
  showIgnored(floor.ignored);
  showSensors(floor.sensors);
  $("on").hidden = floor.off.length > 0;
  showRows("off", floor.off.map((control) => row(cell(control.id), cell(control.off_text))));
  $("footer").textContent = `underfoot ${floor.version}`;
}

function showNothing(why) {
  document.body.classList.add("old");
  $("status").textContent = "no connection";
  $("status").className = "badge failed";
  $("reasons").replaceChildren(item(`The server does not answer (${why}). The numbers below are old.`));
  before = null;
}

async function look() {
  try {
    // A floor that has failed answers as well, with status 503.
    const answer = await fetch("/health", { cache: "no-store", signal: AbortSignal.timeout(PATIENCE) });
    if (!answer.headers.get("Content-Type")?.startsWith("application/json")) throw new Error(await answer.text());
    show(await answer.json());
  } catch (error) {
    showNothing(error.message);
  }
  setTimeout(look, LOOK_EVERY);
}

look();
