/** Wait in milliseconds before the second attempt to connect; it doubles with each further one. */
const FIRST_WAIT = 250;

/** Longest wait in milliseconds before an attempt. */
const LONGEST_WAIT = 8000;

/** Time in milliseconds without a line after which a connection counts as lost; the floor sends one each second. */
const SILENCE = 3000;

/**
 * A connection to the floor's WebSocket that is made again whenever it ends.
 */
export class Link {
  #url;
  #take;
  #lost;
  #socket = null;
  #attempts = 0;
  #heardAt = 0;
  #retry = null;
  #watch = null;

  /** Calls `take` with the text of each line, and `lost` with a sentence at the end of each connection or attempt. */
  constructor(url, take, lost) {
    this.#url = url;
    this.#take = take;
    this.#lost = lost;
    this.#open();
  }

  /** Sends a text. Returns false without a connection; nothing is kept for later. */
  send(text) {
    if (this.#socket?.readyState !== 1) return false;
    this.#socket.send(text);
    return true;
  }

  /** Ends the connection for good. */
  close() {
    clearTimeout(this.#retry);
    this.#leave();
  }

  #open() {
    const socket = new WebSocket(this.#url);
    this.#socket = socket;
    this.#heardAt = performance.now();
    socket.onmessage = ({ data }) => {
      this.#attempts = 0;
      this.#heardAt = performance.now();
      this.#take(data);
    };
    // An error is followed by the end of the connection, which says no more about it than this.
    socket.onerror = () => {};
    socket.onclose = () => this.#end(`there is no connection to ${this.#url}`);
    this.#watch = setInterval(() => this.#look(), SILENCE / 4);
  }

  // A cable that is pulled ends no connection. Messages wait for no timer, so a late timer sees their time too.
  #look() {
    if (performance.now() - this.#heardAt >= SILENCE) {
      this.#end(`nothing has come from ${this.#url} for ${SILENCE / 1000} s`);
    }
  }

  #end(why) {
    this.#leave();
    this.#retry = setTimeout(() => this.#open(), this.#wait());
    this.#lost(why);
  }

  // Different for each page, so that not all of them come at once to a floor that has started again.
  #wait() {
    const wait = Math.min(FIRST_WAIT * 2 ** this.#attempts, LONGEST_WAIT);
    this.#attempts += 1;
    return wait * (0.5 + Math.random() / 2);
  }

  #leave() {
    clearInterval(this.#watch);
    const socket = this.#socket;
    this.#socket = null;
    if (!socket) return;
    socket.onmessage = socket.onclose = null;
    socket.close();
  }
}
