/** Limits as parameters: an end that is open is infinite, both ends 0 are no limits. */

/** A machine of a module, or why there is none. parameters: by name, an open end of a limit infinite. */
export function created(module, parameters) {
  const plain = { ...parameters };
  const limits = {};
  for (const { name, lower, upper } of module.description.limits) {
    const ends = [plain[lower], plain[upper]];
    if (ends.every((end) => end === undefined || Number.isFinite(end))) continue;
    limits[name] = ends.map((end) => (Number.isFinite(end) ? end : null));
    delete plain[lower];
    delete plain[upper];
  }
  return module.create(plain, limits);
}

/** The parameters for limits that are given by names: [lower, upper], null for an end or for both without a limit. */
export function endsOf(description, limits) {
  const found = {};
  for (const { name, lower, upper } of description.limits) {
    const [low, high] = limits[name] ?? [null, null];
    if (low === null && high === null) continue;
    found[lower] = low ?? -Infinity;
    found[upper] = high ?? Infinity;
  }
  return found;
}

/** The limits that parameters give, by names, as `endsOf` takes them. */
export function limitsOf(description, parameters) {
  const ends = description.limits.map(({ name, lower, upper }) => [name, [parameters[lower], parameters[upper]]]);
  const given = ends.filter(([, pair]) => pair.some((end) => end !== 0));
  return given.map(([name, pair]) => [name, pair.map((end) => (Number.isFinite(end) ? end : null))]);
}

/** What an empty field of a parameter means: of an end of a limit that there is none; null for any other. */
export function openEnd(description, name) {
  if (description.limits.some(({ lower }) => lower === name)) return -Infinity;
  return description.limits.some(({ upper }) => upper === name) ? Infinity : null;
}
