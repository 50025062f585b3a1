// Serves the page from the browser's own store, so that it opens without a network after the first visit.
const version = "VERSION";
const files = [
  "./", "index.html", "page.css", "page.js", "files.js", "served.js", "sound.js", "underfoot.js", "underfoot.wasm",
];

addEventListener("install", (event) => {
  const fresh = files.map((file) => new Request(file, { cache: "reload" }));
  event.waitUntil(caches.open(version).then((cache) => cache.addAll(fresh)).then(() => skipWaiting()));
});

// The files of other versions go; all files of one page are of one version, since the store has them all.
addEventListener("activate", (event) => {
  const drop = (names) => names.filter((name) => name !== version).map((name) => caches.delete(name));
  event.waitUntil(caches.keys().then((names) => Promise.all(drop(names))).then(() => clients.claim()));
});

addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || new URL(request.url).origin !== location.origin) return;
  const stored = caches.open(version).then((cache) => cache.match(request, { ignoreSearch: true }));
  event.respondWith(stored.then((response) => response ?? fetch(request)));
});
