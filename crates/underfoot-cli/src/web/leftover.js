// Takes the place of the service worker that an underfoot page from static files left at this address, such as that of
// a server that ran here before: that worker would go on to show its stored page in the place of the floor's.

// The stores of that page have the first 64 bits of a hash as their names.
const STORE = /^[0-9a-f]{16}$/;

addEventListener("install", () => skipWaiting());

addEventListener("activate", (event) => event.waitUntil((async () => {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => STORE.test(name)).map((name) => caches.delete(name)));
  await registration.unregister();
  // Pages that the other worker has opened; drafts stay in the storage.
  const pages = await clients.matchAll({ type: "window" });
  await Promise.all(pages.map((page) => page.navigate(page.url)));
})()));
