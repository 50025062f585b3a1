"use strict";
// The floor's plain page: controls, values, holds and feet live.
// A control counts as held for this long (ms) after a line that says so: lines may stop at any time.
const BELIEVED_FOR = 100;
const $ = (id) => document.getElementById(id);
let floor = null, controls = new Map(), contacts = [], held = [], heldAt = -Infinity, page = null, link = "waiting";
let socket = null, clients = "", why = "", disbelief = 0, frame = 0;

function connect() {
  socket = new WebSocket((location.protocol === "https:" ? "wss://" : "ws://") + location.host + "/");
  socket.onmessage = (message) => take(JSON.parse(message.data));
  socket.onclose = () => {
    link = "no connection"; why = ""; contacts = []; hold([]);
    setTimeout(connect, 1000);
  };
}

function take(line) {
  if (line.held) return hold(line.held);
  const control = controls.get(line.id);
  switch (line.event) {
    case "floor":
      floor = line; page = line.page; link = line.link; why = line.why || "";
      controls = new Map(line.controls.map((control) => [control.id, control]));
      $("title").textContent = line.title || "Floor";
      makeRows();
      break;
    case "contacts": contacts = line.contacts; break;
    case "link": link = line.state; break;
    case "link_cause": why = line.why; break;
    case "page": page = line.page; break;
    case "clients": clients = `, ${line.connected} watching, ${line.dropped} dropped`; break;
    case "error": $("refusal").textContent = `${line.request}: ${line.why}`; break;
    case "state": if (control) { control.value = line.value; control.label = line.label; } break;
    case "changed": if (control) control.value = line.value; break;
  }
  redraw();
}

// Shown at once, not with the next frame, which may be late in the background or on a busy machine.
function hold(ids) {
  held = ids; heldAt = performance.now();
  clearTimeout(disbelief);
  if (held.length) disbelief = setTimeout(() => hold([]), BELIEVED_FOR);
  controls.forEach(showHeld);
  redraw();
}

// In the background, the timer may fire late: checks the age again.
function isHeld(id) { return performance.now() - heldAt < BELIEVED_FOR && held.includes(id); }

function showHeld(control) {
  const row = $("row-" + control.id), text = isHeld(control.id) ? "held" : "";
  if (row) { write(row.cells[2], text); if (row.className !== text) row.className = text; }
}

// Writes only changes, so that unchanged text costs nothing.
function write(place, text) { if (place.textContent !== text) place.textContent = text; }

function ask(request, ...args) {
  $("refusal").textContent = "";
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ request, args }));
}

function makeRows() {
  $("controls").replaceChildren(...[...controls.values()].map((control) => {
    const row = document.createElement("tr");
    row.id = "row-" + control.id;
    for (const text of [control.id, "", ""]) row.insertCell().textContent = text;
    const cell = row.insertCell();
    if (typeof control.value === "boolean" || typeof control.value === "number") {
      const input = document.createElement("input");
      input.setAttribute("aria-label", "set " + control.id);
      const isSwitch = typeof control.value === "boolean";
      input.type = isSwitch ? "checkbox" : "number";
      if (isSwitch) input.checked = control.value; else { input.step = "any"; input.value = control.value; }
      input.onchange = () => ask(`widget/${control.id}/set`, isSwitch ? input.checked : Number(input.value));
      cell.append(input);
    }
    return row;
  }));
}

function shown(value) {
  if (value === null || value === undefined) return "";
  if (typeof value === "number") return String(Math.round(value * 1000) / 1000);
  return Array.isArray(value) ? value.map(shown).join(", ") : String(value);
}

// Requests a frame after a change; several changes share one.
function redraw() { frame ||= requestAnimationFrame(draw); }

function draw() {
  frame = 0;
  write($("state"), link + clients + (why && `: ${why}`));
  if (!floor) return;
  const canvas = $("floor"), scale = canvas.width / floor.width_m, pen = canvas.getContext("2d");
  const height = Math.round(floor.depth_m * scale);
  if (canvas.height !== height) canvas.height = height;
  // North is up.
  const x = (m) => m * scale, y = (m) => height - m * scale;
  pen.clearRect(0, 0, canvas.width, height);
  pen.textAlign = "center"; pen.textBaseline = "middle"; pen.font = "16px sans-serif";
  for (const control of controls.values()) {
    const row = $("row-" + control.id), on = isHeld(control.id);
    showHeld(control);
    if (row) {
      write(row.cells[1], shown(control.value));
      const input = row.cells[3].firstChild;
      if (input && input !== document.activeElement) {
        if (input.type === "checkbox") input.checked = control.value; else input.value = shown(control.value);
      }
    }
    if (control.page && control.page !== page) continue;
    const left = x(control.x_m), top = y(control.y_m + control.depth_m);
    const wide = control.width_m * scale, deep = control.depth_m * scale;
    pen.fillStyle = on ? "#7a5200" : "#2f3944"; pen.strokeStyle = on ? "#ffb000" : "#6b7885";
    pen.fillRect(left, top, wide, deep); pen.strokeRect(left, top, wide, deep);
    pen.fillStyle = "#e6e6e6";
    pen.fillText(control.label || control.id, left + wide / 2, top + deep / 2 - 10, wide);
    pen.fillText(shown(control.value), left + wide / 2, top + deep / 2 + 12, wide);
  }
  for (const foot of contacts) {
    // A person of 800 N makes a disc of 14 cm.
    pen.beginPath();
    pen.arc(x(foot.x_m), y(foot.y_m), Math.sqrt(foot.force_n / 800) * 0.07 * scale, 0, 7);
    pen.fillStyle = "#4fc3f7aa"; pen.fill();
  }
}

// A program with the web edition serves that in this place.
$("note").hidden = location.pathname !== "/";
document.addEventListener("visibilitychange", redraw);
connect();
redraw();
