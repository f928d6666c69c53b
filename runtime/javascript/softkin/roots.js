/**
 * All roots of a trial along one joint, by the rules of the Python package.
 *
 * A trial is a function of a place: the joint, the side of its two roots, the number of the direction that is free
 * (-1: none), and its angle. It returns a value, which is zero at a root, with its slope; a guard, which is negative
 * where there is no solution, with its slope; then cosine and sine of every direction. The circle is cut into cells
 * until each holds at most one root. A cell is its map (joint = base + scale s, or base + scale s² with the other side
 * at s < 0), its number of cuts, and both ends: s, and the trial there.
 */

// Every constant is explained in the sources of the compiler: `cells` and `roots`.
import {
  AHEAD, ASIDE, BENT, CELLS, CLOSING, FINEST, FINISHED, FLAT, GAP, NARROW, NEAR_ZERO, NEXT, RESERVE, RIM, SEAM,
  SHIFTS, TOUCHED, TRIALS, TURNED, VANISHING,
} from "./constants.js";

const THIRD = (2 * Math.PI) / 3;

/**
 * True and the results of `finish` at the root that fits and is nearest to the start; false and zeros where there is
 * none, or none is wanted.
 */
export function nearestRoot(trial, finish, start, wanted, count, sides = []) {
  if (wanted) {
    for (const values of finished(trial, finish, start, FINISHED, sides)) return values;
  }
  return [false, ...new Array(count - 1).fill(0)];
}

/** The results of `finish` at all roots that fit, the nearest to the start first. */
export function everyRoot(trial, finish, start, wanted, count, sides = []) {
  return wanted ? [...finished(trial, finish, start, TRIALS, sides)].map((values) => values.slice(1)) : [];
}

function* finished(trial, finish, start, most, sides) {
  const away = (place) => Math.abs(modulo(place.tried - start - AHEAD + Math.PI, 2 * Math.PI) - Math.PI);
  if (sides.length) {
    const places = listed(trial({}), sides).sort((a, b) => away(a) - away(b));
    for (const place of places) {
      const values = finish(place);
      if (values[0]) yield values;
    }
    return;
  }
  const search = new Search(trial);
  let looked = 0;
  for (const shift of SHIFTS) {
    if (shift !== SHIFTS[0] && search.trials + CELLS > TRIALS - RESERVE) return;
    const places = search.roots(start, shift);
    places.sort((a, b) => away(a) - away(b));
    let isThere = false;
    for (const place of places.slice(0, most - looked)) {
      const values = finish(place);
      if (values[0]) {
        isThere = true;
        yield values;
      }
    }
    if (isThere) return;
    looked = Math.min(most, looked + places.length);
  }
}

/** The candidates that are offered, where the trial lists them: of each a joint value, and whether it is one. */
function listed(said, sides) {
  const places = sides.map((side, k) => ({ tried: said[2 * k], side, freed: -1, freed_angle: 0 }));
  return places.filter((_, k) => said[2 * k + 1]);
}

function modulo(value, divisor) {
  return value - divisor * Math.floor(value / divisor);
}

/** A search: the trial, the roots found so far, and the number of trials. */
class Search {
  constructor(trial) {
    this.trial = trial;
    this.found = [];
    this.trials = 0;
  }

  /** Candidates for roots, in no order; only the complete closure decides whether a candidate is a root. */
  roots(start, shift) {
    const width = (2 * Math.PI) / CELLS;
    this.found = [];
    const maps = Array.from({ length: CELLS }, (_, k) => ({
      base: width * (k + shift), scale: width, curved: false,
    }));
    const results = maps.map((map) => this.evaluate(map, 0));
    const still = { base: start, scale: 0, curved: false };
    this.offer(still, 0, this.evaluate(still, 0));
    for (let k = 0; k < CELLS; k += 1) {
      const map = maps[k];
      const cells = [{ map, cuts: 0, low: 0, first: results[k], high: 1, last: results[(k + 1) % CELLS] }];
      while (cells.length) cells.push(...this.cut(cells.pop()));
    }
    return this.found;
  }

  /** The results of the trial at s, with slopes by s. */
  evaluate(map, s) {
    this.trials += 1;
    const results = this.trial(placeOf(map, s));
    const rate = map.curved ? 2 * map.scale * s : map.scale;
    results[1] *= rate;
    results[3] *= rate;
    return results;
  }

  /** The cells into which a cell must be cut; none where its root is found, or it has no root. */
  cut(cell) {
    const { map, cuts, low, first, high, last } = cell;
    if (this.trials > TRIALS - RESERVE) return [];
    const width = high - low;
    const extent = extentOf(map, low, high);
    const [f, df, g, dg] = first;
    const [f1, df1, g1, dg1] = last;
    const seam = map.curved && -2 * SEAM <= low && high <= 2 * SEAM;
    if (turned(first, last) < TURNED) {
      if (extent > NARROW && !seam) return this.halves(cell, low + ASIDE * width);
      if (g >= -GAP || g1 >= -GAP) {
        this.jump(cell);
        if (seam) this.touch(cell, seam);
      }
      return [];
    }
    if (!map.curved && extent > NARROW && hidesRoots(g, dg, g1, dg1, width)) {
      return this.halves(cell, low + where(cuts, g, dg, g1, dg1, width));
    }
    if (!map.curved && g < 0 !== g1 < 0) return this.overTheEnd(cell);
    if (!map.curved && g < 0) return [];
    const changes = f * f1 <= 0;
    const doubtful = hidesRoots(f, df, f1, df1, width);
    const small = Math.min(Math.abs(f), Math.abs(f1)) <= TOUCHED;
    if (doubtful && extent > FINEST && !small && !seam) {
      const s = low + where(cuts, f, df, f1, df1, width);
      const beside = high > 1.5 * SEAM ? SEAM : -SEAM;
      return this.halves(cell, map.curved && Math.abs(s) < SEAM ? beside : s);
    }
    if (changes) {
      this.closeIn(cell);
    } else if (doubtful && (small || seam)) {
      this.touch(cell, seam);
    }
    return [];
  }

  /**
   * Store the end that is nearer to zero. Where the two sides join, both roots of the parabola with the slopes of both
   * ends, or its extremum where it has none.
   */
  touch({ map, low, first, high, last }, seam) {
    const width = high - low;
    const a = first[1] * width;
    const b = last[1] * width;
    if (!seam || !(a * b < 0)) {
      this.found.push(placeOf(map, Math.abs(first[0]) <= Math.abs(last[0]) ? low : high));
      return;
    }
    const bend = b - a;
    const half = Math.sqrt(Math.max(a * a - 2 * bend * first[0], 0)) / Math.abs(bend);
    for (const side of half > 0 ? [-half, half] : [half]) {
      this.found.push(placeOf(map, low + width * Math.min(Math.max(side - a / bend, 0), 1)));
    }
  }

  /** The two parts of a cell that is cut at s. */
  halves(cell, s) {
    const middle = this.evaluate(cell.map, s);
    this.offer(cell.map, s, middle);
    const cuts = cell.cuts + 1;
    return [{ ...cell, cuts, high: s, last: middle }, { ...cell, cuts, low: s, first: middle }];
  }

  /**
   * The cells around a zero of the guard, from the end with solutions to the other side.
   *
   * The sides join where the guard is slightly above zero; on the strip from there to zero they are one curve.
   */
  overTheEnd(cell) {
    const { map, cuts, low, first, high, last } = cell;
    const meet = this.closing(cell, 2, Math.max(first[2], last[2]) > TOUCHED ? TOUCHED : 0).best;
    const rim = this.closing(cell, 2, 0).best;
    const end = map.base + map.scale * meet;
    const within = map.base + map.scale * (first[2] >= 0 ? low : high);
    const curve = { base: end, scale: within - end, curved: true };
    const strip = { base: end, scale: map.scale * (rim - meet), curved: false };
    const parts = [[curve, -0.5, 0.5], [curve, 0.5, 1], [strip, 0, RIM]];
    const cells = parts.map(([path, a, b]) => {
      const begin = this.evaluate(path, a);
      return { map: path, cuts, low: a, first: begin, high: b, last: this.evaluate(path, b) };
    });
    for (const part of cells) this.offer(part.map, part.low, part.first);
    return cells;
  }

  /** Store the place of a trial if it is a root. Where the guard vanishes, the value has half of its digits. */
  offer(map, s, results) {
    const value = Math.abs(results[0]);
    const guard = results[2];
    if (!((value <= VANISHING && guard >= 0) || (value <= NEXT && Math.abs(guard) <= VANISHING))) return;
    const place = placeOf(map, s);
    const isSame = (o) => o.side === place.side && o.freed === -1 && Math.abs(place.tried - o.tried) < FLAT;
    if (!this.found.some(isSame)) this.found.push(place);
  }

  /**
   * Find the place where a column equals a level: both ends, the better one, and the trial there.
   *
   * Newton's method from the end nearer to zero; bisection outside the cell, and in every third step.
   */
  closing(cell, column, level) {
    let { low, first, high, last } = cell;
    let a = first[column] - level;
    let b = last[column] - level;
    for (let number = 0; number < CLOSING && a !== 0 && b !== 0; number += 1) {
      const isBetter = Math.abs(a) <= Math.abs(b);
      const slope = (isBetter ? first : last)[column + 1];
      let s = (isBetter ? low : high) - (slope !== 0 ? (isBetter ? a : b) / slope : 0);
      if (!(low < s && s < high) || slope === 0 || number % 3 === 2) s = low + ASIDE * (high - low);
      const results = this.evaluate(cell.map, s);
      const value = results[column] - level;
      if (value < 0 === a < 0) {
        [low, first, a] = [s, results, value];
      } else {
        [high, last, b] = [s, results, value];
      }
      if (Math.abs(value) <= FINEST * Math.abs(results[column + 1]) || extentOf(cell.map, low, high) <= FINEST) break;
    }
    const isLow = Math.abs(a) <= Math.abs(b);
    return { low, high, best: isLow ? low : high, results: isLow ? first : last };
  }

  /** Store the root of a cell that holds one and, where the value jumps, the roots with a free angle. */
  closeIn(cell) {
    const { low, high, best, results } = this.closing(cell, 0, 0);
    this.found.push(placeOf(cell.map, best));
    if (Math.abs(results[0]) > TOUCHED) {
      const first = this.evaluate(cell.map, low);
      this.jump({ map: cell.map, cuts: 0, low, first, high, last: this.evaluate(cell.map, high) });
    }
  }

  /** Store the roots at a constant joint, where the angle that turns most is free: the angles of value 0. */
  jump({ map, low, first, high, last }) {
    if (first.length === 4) return;
    const { tried, side } = placeOf(map, 0.5 * (low + high));
    let freed = 0;
    for (let k = 1; 2 * k + 4 < first.length; k += 1) if (turn(first, last, k) < turn(first, last, freed)) freed = k;
    this.trials += 3;
    const at = (angle) => ({ tried, side, freed, freed_angle: angle });
    const [a, b, c] = [0, 1, 2].map((k) => this.trial(at(k * THIRD))[0]);
    const level = (a + b + c) / 3;
    const along = a - level;
    const across = (b - c) / Math.sqrt(3);
    const swing = Math.hypot(along, across);
    const centre = Math.atan2(across, along);
    const half = swing > 0 ? Math.acos(Math.min(Math.max(-level / swing, -1), 1)) : 0.5 * Math.PI;
    const angles = [centre - half, centre + half];
    if (Math.abs(level) + swing <= NEXT) angles.push(centre - half + Math.PI, centre + half + Math.PI);
    this.found.push(...angles.map(at));
  }
}

/** The place of a trial. */
function placeOf({ base, scale, curved }, s) {
  if (curved) return { tried: base + scale * s * s, side: s < 0 ? -1 : 1, freed: -1, freed_angle: 0 };
  return { tried: base + scale * s, side: 1, freed: -1, freed_angle: 0 };
}

/** The distance that the joint travels from one end of a cell to the other. */
function extentOf({ scale, curved }, low, high) {
  return Math.abs(scale) * (high - low) * (curved ? Math.abs(low) + Math.abs(high) : 1);
}

/** The place of the cut: where tangents meet, and near the middle in every third step. */
function where(cuts, f, df, f1, df1, width) {
  if (cuts % 3 === 2) return ASIDE * width;
  return Math.min(Math.max(between(f, df, f1, df1, width), 0.02 * width), 0.98 * width);
}

/** The cosine of the angle by which a direction turns. */
function turn(first, last, k) {
  return first[4 + 2 * k] * last[4 + 2 * k] + first[5 + 2 * k] * last[5 + 2 * k];
}

/** The cosine of the angle by which the direction turns that turns most. */
function turned(first, last) {
  let least = first.length > 4 ? Infinity : 1;
  for (let k = 0; 2 * k + 4 < first.length; k += 1) least = Math.min(least, turn(first, last, k));
  return least;
}

/** The distance from the first end at which the tangents of both ends meet; about half the cell if they do not. */
function between(f, df, f1, df1, width) {
  if (df === df1) return ASIDE * width;
  const met = (f1 - f - df1 * width) / (df - df1);
  return met > 0 && met < width ? met : ASIDE * width;
}

/** Whether there may be more roots within a cell than the signs at its ends show. */
function hidesRoots(f, df, f1, df1, width) {
  const sign = f < 0 ? -1 : 1;
  const crosses = sign * (f + df * width) < 0 || sign * (f1 - df1 * width) < 0;
  if (f * f1 > 0 && df * df1 > 0 && crosses) return true; // a tangent reaches zero, extrema on both sides
  return comesBack(f, df, f1, df1, width) || isDoubtful(f, df * width, f1, df1 * width);
}

/**
 * Whether a value with one sign at both ends falls towards zero from both, and its tangents nearly meet beyond it.
 *
 * Where they do not meet in between, the value has an inflection and may reach zero, too. Tangents are no bound on a
 * value with kinks.
 */
function comesBack(f, df, f1, df1, width) {
  const sign = f < 0 ? -1 : 1;
  if (!(f * f1 > 0 && sign * df < 0 && sign * df1 > 0)) return false;
  const rest = f1 - f - df1 * width;
  if (!(rest * (df - df1) > 0 && Math.abs(rest) < Math.abs(df - df1) * width)) return true;
  const margin = TOUCHED + NEAR_ZERO * Math.min(Math.abs(f), Math.abs(f1)) + BENT * Math.abs(df1 - df) * width;
  return sign * (f + df * between(f, df, f1, df1, width)) <= margin;
}

/** Whether the cubic with these values and slopes has an extremum in the cell that may hide two roots. */
function isDoubtful(f, a, f1, b) {
  const rise = f1 - f;
  const sign = (f * f1 < 0 ? rise : f) < 0 ? -1 : 1;
  const cube = a + b - 2 * rise;
  const square = 3 * rise - 2 * a - b;
  const radicand = square * square - 3 * cube * a;
  if (radicand <= 0 || cube === 0) return false;
  const root = Math.sqrt(radicand);
  const inside = [(-square - root) / (3 * cube), (-square + root) / (3 * cube)].filter((u) => u > 0 && u < 1);
  if (!inside.length) return false;
  if (f * f1 < 0) return sign * a >= 0 && sign * b >= 0;
  const lowest = Math.min(...inside.map((u) => sign * (f + u * (a + u * (square + u * cube)))));
  return f * f1 > 0 && lowest <= NEAR_ZERO * Math.min(Math.abs(f), Math.abs(f1));
}
