// Orbits in doubles. The functions called here, taylor_flight and follow, are the package's own kernels in JavaScript,
// over the recurrence that was emitted for this f and g. An entry of SIDES flies from one wall: from the upper one the
// model with x -> -x, whose lower wall that is.

const EPSILON = Math.pow(2, -52);
// A chatter is summed to leading order when what is left of it is below this part of the forcing's time scale: the next
// term is smaller by the same factor.
const SHORT = 1e-7;
// x' at a hit below this part of the launch velocity is reported: the next states have lost so many digits.
const NEAR_GRAZE = 1e-4;
// The sign of a_c is taken at so many times a period, or a unit of time where g has no period, to find a lift-off.
const LIFT_PLACES = 400;
const REST = 50;  // the ending of an orbit that stays at rest
const WORDS = {
  0: "all impacts asked for were flown", 3: "no impact follows before the horizon",
  5: "the next flight touches x = c so nearly that doubles do not decide whether it is an impact",
  [ACROSS + 5]: "the next flight touches the upper wall so nearly that doubles do not decide whether it is an impact",
  21: "the next flight takes too many steps", 22: "the next flight ends at a singularity of f or g",
  23: "the motion leaves the range of numbers", [REST]: "the mass rests on the obstacle and does not lift off",
};

// What flies from the lower wall; `across` has what flies from the upper one, if there is one.
function flyer(clearance, restitution, given, period, upper_restitution) {
  const { upper } = MODEL, gap = upper === null ? Infinity : upper - clearance;
  const fly = side(0, clearance, gap, restitution, given, period);
  if (upper !== null) {
    fly.across = side(1, -upper, gap, upper_restitution ?? SIDES[1].MODEL.r, given, period);
    fly.across.across = fly;
  }
  return fly;
}

function side(wall, clearance, gap, restitution, given, period) {
  const kernels = SIDES[wall], { numbers, rows, order, safety, horizon, reach, budget } = kernels.MODEL;
  const own = Object.keys(MODEL.parameters).every((name) => given[name] === MODEL.parameters[name]);
  const p = own ? numbers.slice() : [0, ...kernels.constants_of(given)];
  p[0] = clearance;
  const row = () => new Float64Array(order + 16);
  const work = { X: row(), W: Array.from({ length: rows }, row), q: row() };
  const rules = { order, ulp: safety * EPSILON, horizon, reach, budget, gap };
  const law = kernels.law_of(given, restitution);
  return { ...kernels, wall, gap, p, work, rules, w: law.w, r: law.r, period };
}

function wall_acceleration(fly, tau) {
  fly.coefficients([tau], 0, 0, 0, 0, 2, fly.p, fly.work);
  return 2 * fly.work.X[2];
}

// [code, flight time, x' at the hit] of the launch from x = c; v = 0 lifts off from rest, where a_c = 0 and rises.
function launched(fly, tau, v, lifts) {
  const removed = v > 0 ? 1 : lifts ? 3 : 2;
  const found = fly.taylor_flight([tau], v, removed, lifts ? 0 : NaN, fly.p, fly.rules, fly.work, []);
  return [found[0], found[1], found[2]];
}

// The first time after tau at which a_c becomes positive, by its sign at LIFT_PLACES times a period and bisection.
function lift_off(fly, tau) {
  const step = (fly.period || 1) / LIFT_PLACES, most = fly.period ? LIFT_PLACES + 1 : 100 * LIFT_PLACES;
  for (let n = 1; n <= most; n += 1) {
    let low = tau + (n - 1) * step, high = tau + n * step;
    if (wall_acceleration(fly, high) > 0) {
      for (let k = 0; k < 80; k += 1) {
        const middle = (low + high) / 2;
        if (wall_acceleration(fly, middle) > 0) high = middle; else low = middle;
      }
      return high;
    }
  }
  return Infinity;
}

// The events of an orbit: times, velocities away from the wall after them, walls (0, or 1 for the upper one), kinds as
// `Orbit.kind`, x' before each impact in the direction away from its wall, an ending.
function flown(start, tau, v, most) {
  let fly = start;
  const orbit = { tau: [tau], v: [v], wall: [fly.wall], kind: ["start"], before: [NaN], ending: 0 };
  const add = (time, speed, kind, hit) => {
    orbit.tau.push(time); orbit.v.push(speed); orbit.wall.push(fly.wall); orbit.kind.push(kind); orbit.before.push(hit);
  };
  const rate = fly.period ? 2 * Math.PI / fly.period : 1;
  let since = 0, lost = 0, lifts = false;  // the sum of flight times, and what it has lost
  for (let n = 0; n < most; n += 1) {
    let now = tau + (since - lost);
    const a = v > 0 || !lifts ? wall_acceleration(fly, now) : 0;
    const left = a < 0 && fly.r < 1 ? 2 * v / (-a * (1 - fly.r)) : Infinity;
    if (left * rate < SHORT) {  // v = 0 too
      if (v > 0) {
        add(now + left, 0, "complete", NaN);
        now += left;
      }
      const leaves = lift_off(fly, now);
      if (leaves === Infinity) {
        orbit.ending = REST;
        return orbit;
      }
      add(leaves, 0, "release", NaN);
      since = leaves - tau; lost = 0; v = 0; lifts = true;
      continue;
    }
    const [code, time, hit] = launched(fly, now, v, lifts);
    if (code >= ACROSS) fly = fly.across;
    if (code % ACROSS !== 0) {
      orbit.ending = code % ACROSS === 5 && fly.wall ? ACROSS + 5 : code % ACROSS;
      return orbit;
    }
    const part = time - lost, total = since + part;
    lost = (total - since) - part; since = total;
    v = fly.rebound(hit, fly.w); lifts = false;
    add(tau + (since - lost), v, "impact", hit);
  }
  return orbit;
}

// x - c and x' at times after a launch (negative: before), which run away from 0 in one direction.
function followed(fly, tau, v, times) {
  const out = times.map(() => [NaN, NaN]);
  fly.work.q[0] = 0;
  fly.follow([tau], v, times, fly.p, fly.rules, fly.work, out);
  return out;
}

// x - c of an orbit up to a time: [t, x - c] of points, a dozen and more a flight; `fly` is that of the lower wall.
function motion(fly, orbit, until) {
  const points = [];
  for (let n = 0; n < orbit.tau.length && orbit.tau[n] < until; n += 1) {
    const start = orbit.tau[n], rests = orbit.kind[n] === "complete" || (orbit.kind[n] === "start" && orbit.kind[n + 1] === "release");
    const from = orbit.wall[n] ? fly.across : fly, height = (z) => orbit.wall[n] ? fly.gap - z : z;
    points.push([start, height(0)]);
    if (rests || orbit.kind[n + 1] === "complete") continue;
    const last = n + 1 < orbit.tau.length ? orbit.tau[n + 1] : orbit.ending === 3 || orbit.ending % ACROSS === 5 ? until : start;
    const count = Math.min(200, 12 + Math.ceil(24 * (last - start) / (fly.period || 1)));
    const times = Array.from({ length: count - 1 }, (_, k) => (k + 1) * (last - start) / count);
    followed(from, start, orbit.v[n], times).forEach((each, k) => points.push([start + times[k], height(each[0])]));
  }
  return points;
}

// Z, H and P as lines [x, y, x, y, ...], from the signs of y = (x - c)/t^2 of flights at rest on a grid. A flight that
// is seen above the upper wall at a time of the grid is left out from there on.
function sketched(fly, window, across, up) {
  const [t0, t1] = window.t, taus = [], times = [];
  for (let i = 0; i <= across; i += 1) taus.push(window.tau[0] + (window.tau[1] - window.tau[0]) * i / across);
  for (let j = 0; j <= up; j += 1) times.push(t0 + (t1 - t0) * (j + 0.37) / (up + 1));  // 0 is never among them
  const back = times.filter((t) => t < 0).reverse(), ahead = times.filter((t) => t > 0);
  const below = (flights) => {
    const met = flights.findIndex(([z]) => z > fly.gap);
    // a crossing may lie just before that time, here or in the next column
    return flights.map((each, k) => met >= 0 && k > met + 1 ? [NaN, NaN] : each);
  };
  const columns = taus.map((tau) => {
    const flights = [...below(followed(fly, tau, 0, back)).reverse(), ...below(followed(fly, tau, 0, ahead))];
    return flights.map(([z, u], j) => [tau, times[j], z / (times[j] * times[j]), u]);
  });
  // the crossing of an edge, and its name: neighbouring cells share it
  const crossing = (i, j, upwards) => {
    const a = columns[i][j], b = upwards ? columns[i][j + 1] : columns[i + 1][j];
    if ((a[2] < 0) === (b[2] < 0)) return null;
    const s = a[2] / (a[2] - b[2]);
    return { name: `${i} ${j} ${upwards}`, place: [0, 1, 3].map((k) => a[k] + s * (b[k] - a[k])) };
  };
  const places = new Map(), links = new Map();
  for (let i = 0; i < across; i += 1) {
    for (let j = 0; j < up; j += 1) {
      if (![columns[i][j], columns[i + 1][j], columns[i + 1][j + 1], columns[i][j + 1]].every((each) => Number.isFinite(each[2]))) continue;
      const ends = [crossing(i, j, false), crossing(i + 1, j, true), crossing(i, j + 1, false), crossing(i, j, true)].filter((each) => each);
      for (let n = 0; n + 1 < ends.length; n += 2) {
        for (const [from, to] of [[ends[n], ends[n + 1]], [ends[n + 1], ends[n]]]) {
          places.set(from.name, from.place);
          links.set(from.name, [...(links.get(from.name) || []), to.name]);
        }
      }
    }
  }
  const lines = chained(links).map((line) => line.map((name) => places.get(name)));
  return { Z: lines.map((line) => line.flatMap(([tau, t]) => [tau, t])),
    H: lines.map((line) => line.flatMap(([tau, t]) => [tau + t, -t])),
    P: lines.map((line) => line.flatMap(([tau, t, u]) => [tau + t, u])) };
}

// Names that are linked in pairs, as lines from end to end; a closed line ends where it begins.
function chained(links) {
  const left = new Set(links.keys()), lines = [];
  for (const open of [true, false]) {
    for (const first of links.keys()) {
      if (!left.has(first) || (open && links.get(first).length !== 1)) continue;
      const line = [first];
      left.delete(first);
      for (let next = first; next !== undefined;) {
        next = links.get(next).find((name) => left.has(name));
        if (next !== undefined) { line.push(next); left.delete(next); }
      }
      if (!open) line.push(first);
      lines.push(line);
    }
  }
  return lines;
}
