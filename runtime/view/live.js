/**
 * The machine moved by a controller: `softkin live` serves this page and sends the values of the axes over a WebSocket.
 *
 * The page moves only where every axis has a number that can be trusted; what the connection says is shown.
 */

import { endsOf } from "./limits.js";

const PROTOCOL = "softkin.live.1";
const RETRY = 1500;

/** The token of a run in the fragment of the address; null if the page is not live. */
export function tokenOf(fragment) {
  return new URLSearchParams(fragment.replace(/^#/, "")).get("live");
}

export class Live {
  #waiting = null;

  /**
   * said: called with a sentence and whether the machine follows; keywords: of a machine, the names of its parameters
   * here, and in Python where these differ; Socket: what connects.
   */
  constructor(model, token, said, keywords = {}, Socket = globalThis.WebSocket) {
    Object.assign(this, { model, token, said, keywords, Socket });
    this.#connect();
  }

  #connect() {
    const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`;
    const socket = new this.Socket(address, [PROTOCOL, `token.${this.token}`]);
    socket.onmessage = ({ data }) => this.#receive(JSON.parse(data));
    socket.onclose = () => {
      this.said("no connection to softkin live: trying again", false);
      clearTimeout(this.#waiting);
      this.#waiting = setTimeout(() => this.#connect(), RETRY);
    };
  }

  #receive(message) {
    if (message.type === "machine") this.#open(message);
    else if (message.type === "axes") this.#move(message);
  }

  #open({ machine, name, source }) {
    let bare = machine;
    while (bare.bare) bare = bare.bare; // base and tool move with the machine: its axes are the same
    const { mechanism, limits = {}, ...given } = bare;
    const { names } = this.model;
    this.count = -1; // nothing moves before its machine is shown
    const found = [name, mechanism, names.length === 1 ? names[0] : null].find((one) => names.includes(one));
    if (!found) {
      this.said(`this page does not have the machine ${name}`, false);
      return;
    }
    const description = this.model.describe(found);
    const own = new Map(Object.entries(this.keywords[found] ?? {}).map(([here, there]) => [there, here]));
    const usual = description.parameters.filter((one) => one.default !== null).map((one) => [one.name, one.default]);
    const named = Object.entries(given).map(([key, value]) => [own.get(key) ?? key, value]);
    this.model.open(found, { parameters: { ...Object.fromEntries([...usual, ...named]), ...endsOf(description, limits) } });
    if (this.model.wrong) {
      this.said(`this page cannot show the machine: ${this.model.wrong.words}: ${this.model.wrong.names.join(", ")}`, false);
      return;
    }
    this.count = description.axes.length;
    this.said(`${source.kind}: connecting`, false);
  }

  #move({ status, message, retry_in: wait, complete, axes, quality, reasons }) {
    const doubtful = quality.findIndex((one) => one !== "good");
    const words = doubtful < 0 ? "" : `, axis ${doubtful + 1} ${quality[doubtful]}${reasons[doubtful] ? ` (${reasons[doubtful]})` : ""}`;
    const next = status === "lost" && wait !== null ? `, next try in ${wait.toFixed(1)} s` : "";
    this.said(`${status}${message ? `: ${message}` : ""}${next}${words}`, status === "live" && doubtful < 0);
    if (complete && axes.length === this.count && axes.every(Number.isFinite)) this.model.moveAxes(axes);
  }
}
