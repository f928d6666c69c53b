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
  const given = description.limits.filter(({ name }) => limits[name] !== undefined);
  return Object.assign({}, ...given.map(({ name, lower, upper }) => {
    const [low, high] = limits[name] ?? [null, null];
    const isFree = low === null && high === null;
    return { [lower]: isFree ? 0 : low ?? -Infinity, [upper]: isFree ? 0 : high ?? Infinity };
  }));
}

/** The limits that parameters give other than the machine has by itself, by names, as `endsOf` takes them. */
export function limitsOf(description, parameters) {
  const own = Object.fromEntries(description.parameters.map(({ name, default: usual }) => [name, usual]));
  const changed = description.limits.filter((limit) => [limit.lower, limit.upper].some((end) => parameters[end] !== own[end]));
  return changed.map((limit) => {
    const ends = [limit.lower, limit.upper].map((end) => (Number.isFinite(parameters[end]) ? parameters[end] : null));
    return [limit.name, isFree(limit, parameters) ? null : ends];
  });
}

/** The limits of which a parameter is an end; undefined for any other parameter. */
export function limitOf(description, name) {
  return description.limits.find(({ lower, upper }) => lower === name || upper === name);
}

/** Whether there are no limits. */
export function isFree({ lower, upper }, parameters) {
  return parameters[lower] === 0 && parameters[upper] === 0;
}

/**
 * What changes with a parameter, which is null if its field is empty: of an end of limits both ends. If there
 * were no limits the other end is open, and where both are open there are none.
 */
export function changesWith(description, parameters, name, value) {
  const limit = limitOf(description, name);
  if (!limit) return { [name]: value };
  const given = { ...parameters };
  if (isFree(limit, given)) [given[limit.lower], given[limit.upper]] = [-Infinity, Infinity];
  given[name] = value ?? (name === limit.lower ? -Infinity : Infinity);
  const ends = [given[limit.lower], given[limit.upper]];
  const [lower, upper] = ends.some(Number.isFinite) ? ends : [0, 0];
  return { [limit.lower]: lower, [limit.upper]: upper };
}
