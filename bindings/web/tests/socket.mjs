// `WebSocket` for a Node.js that has none: node --import ./socket.mjs
import WebSocket from "ws";

globalThis.WebSocket ??= WebSocket;
