/**
 * The machine moved by a controller: `softkin live` serves this page and sends the values of the axes over a WebSocket.
 *
 * The page moves only where every axis has a number that can be trusted; what the connection says is shown.
 */

const PROTOCOL = "softkin.live.1";
const RETRY = 1500;

/** The token of a run in the fragment of the address; null where the page is not live. */
export function tokenOf(fragment) {
  return new URLSearchParams(fragment.replace(/^#/, "")).get("live");
}

export class Live {
  #waiting = null;

  /** said: called with a sentence and whether the machine follows; Socket: what connects. */
  constructor(model, token, said, Socket = globalThis.WebSocket) {
    Object.assign(this, { model, token, said, Socket });
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
    const { mechanism, limits = {}, ...parameters } = machine;
    const { names } = this.model;
    const found = [name, mechanism, names.length === 1 ? names[0] : null].find((one) => names.includes(one));
    if (!found) {
      this.said(`this page does not have the machine ${name}`, false);
      return;
    }
    this.count = this.model.describe(found).axes.length;
    this.model.open(found, { parameters: { ...parameters, ...endsOf(this.model.describe(found), limits) } });
    this.said(`${source.kind}: connecting`, false);
  }

  #move({ status, message, complete, axes, quality, reasons }) {
    const doubtful = quality.findIndex((one) => one !== "good");
    const words = doubtful < 0 ? "" : `, axis ${doubtful + 1} ${quality[doubtful]}${reasons[doubtful] ? ` (${reasons[doubtful]})` : ""}`;
    this.said(`${status}${message ? `: ${message}` : ""}${words}`, status === "live" && doubtful < 0);
    if (complete && axes.length === this.count && axes.every(Number.isFinite)) this.model.moveAxes(axes);
  }
}

/** The parameters of limits that are given as [lower, upper] by the names of axes; without both ends there is no limit. */
function endsOf(description, limits) {
  const found = {};
  for (const { name, lower, upper } of description.limits) {
    const pair = limits[name];
    if (pair && pair.every(Number.isFinite)) [found[lower], found[upper]] = pair;
  }
  return found;
}
