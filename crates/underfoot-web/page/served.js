// Where the floor is that this page shows: nowhere else than in the page. `underfoot run --web` answers with its own.
export const mirror = null;
