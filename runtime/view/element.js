/** Elements of the page, in one call each; numbers as they are shown. */

/** An element with attributes (functions are listeners, true and false are set and not set) and children. */
export function element(tag, attributes = {}, ...children) {
  const found = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") found.addEventListener(name, value);
    else if (value !== false && value !== null && value !== undefined) found.setAttribute(name, value === true ? "" : value);
  }
  found.append(...children.filter((child) => child !== null && child !== undefined));
  return found;
}

/** A section of the panel that opens and closes. */
export function section(name, isOpen, ...children) {
  return element("details", { open: isOpen }, element("summary", {}, name), ...children);
}

/** A number for reading: as many digits as are seen, never "-0". */
export function shown(value, digits = 3) {
  const text = Number(value).toFixed(digits).replace(/\.?0+$/, "");
  return text === "-0" || text === "" ? "0" : text;
}

/** The value of a field as a finite number; null if it holds none. */
export function numberIn(field) {
  const value = field.value.trim() === "" ? NaN : Number(field.value);
  return Number.isFinite(value) ? value : null;
}

/** Write a number into a field, unless somebody types in it. */
export function write(field, value, digits = 4) {
  if (document.activeElement !== field || field.type === "range") field.value = shown(value, digits);
}

/** The unit as it is written: lengths have the user's unit. */
export function unitOf(unit) {
  return unit === "deg" ? "°" : unit;
}
