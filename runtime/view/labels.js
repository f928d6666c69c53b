/** The names in the picture: those at one place are one label, and none lies on another, or on the handles of the tool. */

/** Joints that are drawn closer than so many pixels have one label. */
const TOGETHER = 34;
/** The room that a letter, a line and the handles of the tool take. */
const [LETTER, LINE, HANDLE] = [7, 16, 46];
const ASIDE = 12;

export class Labels {
  constructor(layer) {
    this.layer = layer;
  }

  /** names: {text, at: [x, y]}, and `isFixed` of what no other is put together with. handle: the place of the tool. */
  show(names, handle) {
    const labels = [];
    for (const { text, at, isFixed = false } of names) {
      const near = labels.find((one) => !isFixed && !one.isFixed && distance(one.at, at) < TOGETHER);
      if (near) near.texts.push(text);
      else labels.push({ texts: [text], at, isFixed });
    }
    const { children, clientWidth } = this.layer;
    while (children.length < labels.length) this.layer.append(document.createElement("span"));
    const taken = [];
    [...children].forEach((child, i) => {
      child.hidden = i >= labels.length;
      if (child.hidden) return;
      const { texts, at, isFixed } = labels[i];
      const text = [...new Set(texts.flatMap((one) => one.split(" ")))].join(" ");
      const width = LETTER * text.length + 8;
      let [x, y] = isFixed ? at : [at[0] + (at[0] < handle[0] ? -ASIDE - width : ASIDE), at[1] - LINE];
      if (!isFixed && y + LINE > handle[1] - HANDLE && y < handle[1] + HANDLE && Math.abs(x + width / 2 - handle[0]) < HANDLE + width / 2) {
        x = at[0] < handle[0] ? handle[0] - HANDLE - width : handle[0] + HANDLE;
      }
      [x, y] = [Math.max(0, Math.min(x, clientWidth - width)), Math.max(0, y)];
      while (taken.some((one) => x < one.x + one.width && one.x < x + width && Math.abs(one.y - y) < LINE)) y -= LINE;
      taken.push({ x, y, width });
      child.textContent = text;
      child.className = isFixed ? "letter" : "";
      child.style.transform = `translate(${x}px, ${y}px)`;
    });
  }
}

function distance([a, b], [c, d]) {
  return Math.hypot(a - c, b - d);
}
