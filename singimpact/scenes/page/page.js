// What is drawn: FILM has the curves of every place of the slider, MODEL the oscillator, PENS colours and lines,
// GROUNDS what is behind and beside them.

const SVG = "http://www.w3.org/2000/svg";
const at = (id) => document.getElementById(id);
let turn_now = MODEL.period;  // the period at the sliders' parameters, null where it is not known
const UPPER = SIDES.length > 1 ? SIDES[1].MODEL : null;  // numbers of the upper wall, if there is one
const state = { frame: FILM.start, r: MODEL.r, r_upper: UPPER && UPPER.r, given: { ...MODEL.parameters }, start: null, wall: 0, orbit: null };
const NIGHT = matchMedia("(prefers-color-scheme: dark)");
const colours = () => GROUNDS[NIGHT.matches ? "night" : "day"];
const short = (value, digits = 6) => String(Number(value.toPrecision(digits)));

function made(name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  return node;
}

// ---- axes

function ticks(low, high, most) {
  const raw = (high - low) / most, power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= raw);
  const found = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n += 1) found.push(n * step);
  // digits to the step's own: neighbours never get one label
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const size = Math.max(Math.abs(low), Math.abs(high));
  const scale = size < 1e-3 ? Math.pow(10, Math.floor(Math.log10(size))) : 1;
  const shown = (value) => scale === 1 ? value.toFixed(digits) : String(Number((value / scale).toFixed(Math.max(0, digits + Math.floor(Math.log10(scale))))));
  return { found, shown, exponent: Math.round(Math.log10(scale)) };
}

// An empty panel with its axes; `x`, `y` take data to pixels, `data` takes pixels back.
function panel(id, xs, ys, names, shape) {
  const svg = at(id), wide = Math.max(280, svg.parentNode.clientWidth), high = Math.round(wide * shape(wide));
  const box = { left: 58, right: wide - 12, top: 24, bottom: high - 42 };
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${wide} ${high}`);
  svg.setAttribute("aria-label", names.title);
  const x = (value) => box.left + (value - xs[0]) / (xs[1] - xs[0]) * (box.right - box.left);
  const y = (value) => box.bottom - (value - ys[0]) / (ys[1] - ys[0]) * (box.bottom - box.top);
  const clip = made("clipPath", { id: `${id}-clip` });
  clip.append(made("rect", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
  const inside = made("g", { "clip-path": `url(#${id}-clip)` }), frame = made("g", {});
  const across = ticks(...xs, wide < 460 ? 4 : 8), up = ticks(...ys, 6);
  for (const value of across.found) {
    frame.append(made("line", { x1: x(value), x2: x(value), y1: box.top, y2: box.bottom, stroke: colours().grid }));
    frame.append(made("text", { x: x(value), y: box.bottom + 17, "text-anchor": "middle" }, across.shown(value)));
  }
  for (const value of up.found) {
    frame.append(made("line", { x1: box.left, x2: box.right, y1: y(value), y2: y(value), stroke: colours().grid }));
    frame.append(made("text", { x: box.left - 7, y: y(value) + 4, "text-anchor": "end" }, up.shown(value)));
  }
  const raised = (each) => each.exponent ? ` (in 1e${each.exponent})` : "";
  frame.append(made("text", { x: (box.left + box.right) / 2, y: high - 6, "text-anchor": "middle" }, names.x + raised(across)));
  frame.append(made("text", { x: 4, y: 14 }, names.y + raised(up)));
  frame.append(made("rect", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top, fill: "none", stroke: colours().axis }));
  svg.append(clip, frame, inside);
  const data = (px, py) => [xs[0] + (px - box.left) / (box.right - box.left) * (xs[1] - xs[0]),
    ys[0] + (box.bottom - py) / (box.bottom - box.top) * (ys[1] - ys[0])];
  return { svg, inside, x, y, box, data, wide };
}

function stroke(pen) {
  return { fill: "none", stroke: NIGHT.matches ? pen.dark || pen.color : pen.color, "stroke-width": pen.width * 1.25, "stroke-dasharray": pen.dashes, "stroke-linejoin": "round" };
}

function draw(here, name, pieces) {  // pieces: [x, y, x, y, ...]
  let path = "";
  for (const piece of pieces) {
    for (let n = 0; n < piece.length; n += 2) {
      path += `${n ? "L" : "M"}${here.x(piece[n]).toFixed(2)} ${here.y(piece[n + 1]).toFixed(2)}`;
    }
  }
  here.inside.append(made("path", { d: path, "data-curve": name, ...stroke(PENS[name]) }));
}

function dots(here, places, kind, attributes) {
  const group = made("g", { "data-dots": kind, ...attributes });
  for (const [x, y, r] of places) group.append(made("circle", { cx: here.x(x).toFixed(2), cy: here.y(y).toFixed(2), r }));
  here.inside.append(group);
}

// ---- what the sliders say

const moved = () => Object.keys(MODEL.parameters).filter((name) => state.given[name] !== MODEL.parameters[name]);
const frame = () => FILM.frames[state.frame];
const fly = () => flyer(frame().c, state.r, state.given, turn_now, state.r_upper);

// The period at the sliders' parameters: one of p, p old/new and p new/old for each, if g repeats after it.
function period() {
  const names = moved();
  if (!MODEL.period || !names.length) return MODEL.period;
  let tried = [MODEL.period];
  for (const name of names) {
    const ratio = Math.abs(MODEL.parameters[name] / state.given[name]);
    tried = tried.flatMap((each) => [each, each * ratio, each / ratio]);
  }
  const here = fly(), sizes = Array.from({ length: 40 }, (_, k) => wall_acceleration(here, 0.37 + 0.61 * k));
  const most = Math.max(...sizes.map(Math.abs));
  return tried.find((each) => each > 0 && sizes.every((a, k) => Math.abs(wall_acceleration(here, 0.37 + 0.61 * k + each) - a) <= 1e-9 * most)) || null;
}

function window_now() {
  const own = frame(), turn = period();
  if (at("axes").value !== "period" || !turn) return { tau: own.tau, t: own.t, v: own.v };
  const middle = (own.tau[0] + own.tau[1]) / 2;
  const speeds = state.orbit ? state.orbit.v : [own.v[1]];
  const most = speeds.reduce((a, b) => Math.max(a, b), own.v[1]);
  return { tau: [middle - turn / 2, middle + turn / 2], t: own.t, v: [-0.08 * most, 1.08 * most] };
}

// A curve of this place as [x, y, x, y, ...]: the page has the steps between its points, in parts of the window.
function stored(name) {
  const own = frame(), ends = [own.tau, ["Z", "H", "cut"].includes(name) ? own.t : own.v];
  return own.curves[name].map((steps) => {
    const place = [0, 0];
    return steps.map((step, n) => {
      const [low, high] = ends[n % 2];
      return low + (place[n % 2] += step) * (high - low) / FILM.parts;
    });
  });
}

function show() {
  const own = frame(), changed = moved(), view = window_now(), side = (wide) => wide < 460 ? 0.86 : 0.74;
  turn_now = period();
  const surface = panel("surface", own.tau, own.t, { x: "launch phase τ", y: "flight time t", title: "Z and H in the plane of launch phase and flight time" }, side);
  const states = panel("states", view.tau, view.v, { x: "launch phase τ", y: "velocity v", title: "the plane of states: launch phase and velocity" }, side);
  const low = Math.min(states.box.bottom, Math.max(states.box.top, states.y(0)));
  states.inside.append(made("rect", { x: states.box.left, y: low, width: states.box.right - states.box.left, height: states.box.bottom - low, fill: colours().wall }));
  const rest = made("line", { x1: surface.box.left, x2: surface.box.right, y1: surface.y(0), y2: surface.y(0), stroke: colours().axis });
  surface.inside.append(rest);
  const fresh = changed.length ? sketched(fly(), own, 160, 161) : null;
  const curve = (name) => fresh ? (fresh[name] || []) : stored(name);
  for (const name of ["Z", "H"]) draw(surface, name, curve(name));
  for (const name of ["P", "jump"]) draw(states, name, curve(name));
  if (UPPER && !fresh) {
    draw(surface, "cut", curve("cut"));
    draw(states, "cut", curve("cut-launches"));
  }
  draw(states, "gamma", state.r === MODEL.r ? curve("gamma") : []);
  const points = fresh ? [] : own.tangencies.map((tau) => [tau, 0, 4.5]);
  for (const here of [surface, states]) dots(here, points, "tangencies", { fill: colours().ink });
  show_orbit(states, view);
  at("clearance-now").textContent = `${short(own.c)}${state.frame === FILM.swan ? " = c₀, the swan" : ""}`;
  at("clearance").setAttribute("aria-valuetext", at("clearance-now").textContent);
  at("curves-note").textContent = note(changed);
  PAGE_NOW.states = states; PAGE_NOW.surface = surface;
  show_mass();
}

function note(changed) {
  if (changed.length) {
    const own = changed.map((name) => `${name} = ${short(MODEL.parameters[name])}`).join(", ");
    return `Z, H and P are sketched here for these parameters, to about one cell of a grid of 160 by 160. γ, ${UPPER ? "the cut, " : ""}the visible part of P${FILM.swan === null ? "" : ", c₀"} and the tangency points are those of ${own}; they are drawn there only.`;
  }
  if (state.r !== MODEL.r) return `γ depends on r and is drawn at r = ${short(MODEL.r)} only; Z, H and P do not depend on r.`;
  return frame().empty;
}

// ---- the orbit

function start_orbit(tau, v, wall = state.wall) {
  state.start = [tau, v]; state.wall = wall;
  if (UPPER) at("wall").value = wall;
  at("start-tau").value = tau; at("start-v").value = v;
  fly_now();
  show();
}

function fly_now() {
  if (!state.start) return;
  const most = Math.min(5000, Math.max(1, Number(at("impacts").value) || 200));
  turn_now = period();
  state.orbit = flown(state.wall ? fly().across : fly(), state.start[0], state.start[1], most);
}

function show_orbit(states, view) {
  const orbit = state.orbit;
  at("forget").disabled = !orbit;
  if (!orbit) {
    at("notes").textContent = "No orbit yet: click in the plane of states above, or type a launch phase and a velocity. The orbit follows every slider.";
    at("motion").replaceChildren();
    at("motion").setAttribute("viewBox", "0 0 10 0.1");
    at("mass").replaceChildren();
    film = null;
    return;
  }
  const turn = turn_now, sides = [[], []];
  orbit.tau.forEach((tau, n) => {
    const places = sides[orbit.wall[n]];
    if (!turn) places.push([tau, orbit.v[n], 2.6]);
    else {
      for (let m = Math.ceil((view.tau[0] - tau) / turn); tau + m * turn <= view.tau[1]; m += 1) places.push([tau + m * turn, orbit.v[n], 2.6]);
    }
  });
  const looks = [{ fill: PENS.orbit.color, stroke: colours().ink, "stroke-width": 0.7 }, open_dot()];
  sides.forEach((places, wall) => { if (!wall || UPPER) dots(states, places, wall ? "orbit-upper" : "orbit", looks[wall]); });
  dots(states, [[state.start[0], state.start[1], 6]], "start", { fill: "none", stroke: colours().ink, "stroke-width": 1.8 });
  const start = orbit.tau[0], span = turn ? 8 * turn : 50;
  const impacts = orbit.kind.filter((kind) => kind === "impact").length;
  const ends = orbit.tau[orbit.tau.length - 1] + (orbit.ending ? 0.5 * (turn || 1) : 0);
  const until = Math.min(start + span, Math.max(ends, start + 1e-6 * span));
  const flying = fly(), points = motion(flying, orbit, until);
  const rise = UPPER ? flying.gap : points.reduce((a, each) => Number.isFinite(each[1]) ? Math.max(a, each[1]) : a, 0) || 1;
  const here = panel("motion", [start, until], [-0.08 * rise, 1.06 * rise], { x: "time t", y: "x − c", title: "x - c over time" }, (wide) => wide < 600 ? 0.62 : 0.26);
  for (const wall of UPPER ? [0, rise] : [0]) here.inside.append(made("line", { x1: here.box.left, x2: here.box.right, y1: here.y(wall), y2: here.y(wall), stroke: colours().ink, "stroke-width": 1.6, "data-wall": wall }));
  const path = points.filter((each) => Number.isFinite(each[1])).flat();
  here.inside.append(made("path", { d: path.reduce((text, value, n) => n % 2 ? text + here.y(value).toFixed(2) : `${text}${n ? "L" : "M"}${here.x(value).toFixed(2)} `, ""), "data-curve": "motion", ...stroke({ ...PENS.orbit, dashes: "none" }) }));
  film = { here, above: UPPER ? rise : null, points: points.filter((each) => Number.isFinite(each[1])), start, until, turn: turn || span / 8 };
  for (const wall of UPPER ? [0, 1] : [0]) dots(here, orbit.tau.flatMap((tau, n) => tau <= until && n && orbit.wall[n] === wall ? [[tau, wall && rise, 2.4]] : []), wall ? "impacts-upper" : "impacts", looks[wall]);
  const several = (n, one, more) => `${n} ${n === 1 ? one : more}`;
  const across = orbit.kind.filter((kind, n) => kind === "impact" && orbit.wall[n]).length;
  const told = [`${several(impacts, "impact", "impacts")}${UPPER ? `, ${across} of them at the upper wall,` : ""} until t = ${short(orbit.tau[orbit.tau.length - 1])}; ${WORDS[orbit.ending] || `flight ended with code ${orbit.ending}`}.`];
  const count = (kind) => orbit.kind.filter((each) => each === kind).length;
  if (count("complete")) told.push(`${several(count("complete"), "chatter", "chatters")} came to rest.`);
  if (count("release")) told.push(`${several(count("release"), "lift-off", "lift-offs")} from rest.`);
  if (count("release") || orbit.ending === REST) told.push(`A lift-off is looked for at ${LIFT_PLACES} times ${turn ? "a period" : "a unit of time"}: a shorter interval of a_c > 0 is missed.`);
  const grazing = orbit.before.map((hit, n) => Math.abs(hit) < NEAR_GRAZE * orbit.v[n - 1] ? n : 0).filter((n) => n > 0);
  if (grazing.length) told.push(`Impact ${grazing[0]} is nearly a graze, with x' = ${short(orbit.before[grazing[0]], 3)} before it: the later states are known to about ${Math.max(1, Math.round(15 + Math.log10(Math.abs(orbit.before[grazing[0]]) / orbit.v[grazing[0] - 1])))} digits or fewer.`);
  if (until < ends) told.push(`Shown: the first ${turn ? "8 periods" : "50 time units"}.`);
  if (MODEL.period && !turn) told.push("No period of g was found for these parameters: states are drawn at their own times.");
  at("notes").textContent = told.join(" ");
}

// ---- the mass that bounces

let film = null;
const clock = { now: null, running: false, last: 0 };

// x - c of the shown orbit at a time, between the points of its curve.
function height(time) {
  const points = film.points;
  let low = 0, high = points.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle][0] <= time) low = middle; else high = middle;
  }
  const [t0, x0] = points[low], [t1, x1] = points[high];
  return t1 > t0 ? x0 + Math.min(1, Math.max(0, (time - t0) / (t1 - t0))) * (x1 - x0) : x0;
}

function show_mass() {
  const svg = at("mass");
  if (!film) return;
  if (clock.now === null || clock.now < film.start || clock.now > film.until) clock.now = film.start;
  const { here } = film, high = at("motion").viewBox.baseVal.height, x = height(clock.now), wall = here.y(0);
  svg.setAttribute("viewBox", `0 0 70 ${high}`);
  svg.replaceChildren(
    made("rect", { x: 4, y: wall, width: 62, height: Math.max(0, here.box.bottom - wall), fill: colours().grid }),
    made("line", { x1: 4, x2: 66, y1: wall, y2: wall, stroke: colours().ink, "stroke-width": 1.6 }),
    ...(film.above === null ? [] : upper_wall(here.y(film.above) - 24)),
    made("rect", { x: 23, y: here.y(x) - 24, width: 24, height: 24, rx: 3, fill: PENS.orbit.color, "data-height": x, "data-time": clock.now }));
  here.inside.querySelectorAll("[data-now]").forEach((each) => each.remove());
  here.inside.append(made("circle", { cx: here.x(clock.now), cy: here.y(x), r: 5, fill: colours().ink, "data-now": "" }));
}

// The upper wall beside the motion, where the mass meets it with its upper edge.
function upper_wall(y) {
  return [made("rect", { x: 4, y: 0, width: 62, height: Math.max(0, y), fill: colours().grid }),
    made("line", { x1: 4, x2: 66, y1: y, y2: y, stroke: colours().ink, "stroke-width": 1.6 })];
}

function tick(now) {
  if (!clock.running) return;
  if (film) {
    clock.now += Math.min(0.1, (now - clock.last) / 1000) * film.turn / 1.6;  // a period in 1.6 seconds
    if (clock.now > film.until) clock.now = film.start;
    show_mass();
  }
  clock.last = now;
  requestAnimationFrame(tick);
}

function play() {
  clock.running = !clock.running;
  clock.last = performance.now();
  at("play").textContent = clock.running ? "Pause" : "Play";
  if (clock.running) requestAnimationFrame(tick);
}

// ---- files, and the link that keeps the state

function save(name, type, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const csv = () => [`tau,v,kind${UPPER ? ",wall" : ""}`, ...state.orbit.tau.map((tau, n) => `${tau},${state.orbit.v[n]},${state.orbit.kind[n]}${UPPER ? `,${state.orbit.wall[n]}` : ""}`)].join("\n") + "\n";

// The panels below one another, as one file.
function picture() {
  let top = 0, wide = 0;
  const parts = ["surface", "states", "motion"].map(at).filter((each) => each.childNodes.length).map((each) => {
    const { width, height } = each.viewBox.baseVal, here = top;
    top += height + 12; wide = Math.max(wide, width);
    return `<svg y="${here}" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">${[...each.childNodes].map((node) => new XMLSerializer().serializeToString(node)).join("")}</svg>`;
  });
  return `<svg xmlns="${SVG}" width="${wide}" height="${top}" viewBox="0 0 ${wide} ${top}"><style>text { font: 12px sans-serif; fill: ${colours().ink}; }</style><rect width="100%" height="100%" fill="${colours().ground}"/>${parts.join("")}</svg>`;
}

function address() {
  const kept = { c: frame().c, r: state.r, ...Object.fromEntries(Object.keys(MODEL.parameters).map((name) => [`p.${name}`, state.given[name]])) };
  if (UPPER) kept.r_upper = state.r_upper;
  if (state.start) [kept.tau, kept.v] = state.start;
  if (state.wall) kept.wall = state.wall;
  return `#${new URLSearchParams(kept)}`;
}

// What the address says, where it says something.
function recall() {
  const kept = new URLSearchParams(location.hash.slice(1)), value = (name) => kept.has(name) && Number.isFinite(Number(kept.get(name))) ? Number(kept.get(name)) : null;
  if (value("c") !== null) to_frame(FILM.frames.reduce((best, each, n) => Math.abs(each.c - value("c")) < Math.abs(FILM.frames[best].c - value("c")) ? n : best, 0));
  for (const name in setters) if (value(name) !== null) setters[name](value(name));
  const own = frame(), middle = (own.tau[0] + own.tau[1]) / 2;
  start_orbit(value("tau") ?? Number(middle.toPrecision(6)), value("v") ?? Number((0.4 * own.v[1]).toPrecision(4)), UPPER && value("wall") === 1 ? 1 : 0);
  if (MODEL.period && Math.max(...state.orbit.v.map(Math.abs)) > own.v[1]) {  // the impacts lie above the window
    at("axes").value = "period";
    show();
  }
}

function to_frame(n) {
  at("clearance").value = n;
  state.frame = n;
}

// ---- controls

const setters = {};

function slider(id, label, low, high, value, changed) {
  const box = document.createElement("div"), step = (high - low) / 200;
  box.className = "control";
  box.innerHTML = `<label for="${id}"><span></span><output></output></label><input type="range" id="${id}" min="0" max="200" step="any">`;
  box.querySelector("span").textContent = label;
  const input = box.querySelector("input"), output = box.querySelector("output");
  const put = (now) => { input.value = (now - low) / step; output.textContent = short(now); };
  input.addEventListener("input", () => {
    const now = Number((low + step * Number(input.value)).toPrecision(4));
    output.textContent = short(now);
    changed(now);
    fly_now(); show();
  });
  put(value);
  document.querySelector(".controls").append(box);
  setters[{ restitution: "r", "restitution-upper": "r_upper" }[id] || `p.${label}`] = (now) => { put(now); changed(now); };
  return () => { put(value); changed(value); };
}

const PAGE_NOW = {}, back = [];

// An impact at the upper wall.
const open_dot = () => ({ fill: colours().ground, stroke: PENS.orbit.color, "stroke-width": 1.5 });

function legend() {
  at("legend").replaceChildren(...LEGEND.map((line) => {
    const item = document.createElement("li"), svg = made("svg", { width: 34, height: 10 });
    svg.append(made("line", { x1: 1, x2: 33, y1: 5, y2: 5, ...stroke(PENS[line.name]) }));
    if (line.dot) svg.replaceChildren(made("circle", { cx: 17, cy: 5, r: 4, ...(line.open ? open_dot() : { fill: line.dot }) }));
    item.append(svg, line.label);
    return item;
  }));
}

function begin() {
  const clearance = at("clearance"), last = FILM.frames.length - 1;
  clearance.max = last; clearance.value = FILM.start;
  clearance.addEventListener("input", () => { state.frame = Number(clearance.value); fly_now(); show(); });
  back.push(() => to_frame(FILM.start));
  if (FILM.swan === null) at("swan").remove();
  else at("swan").addEventListener("click", () => { to_frame(FILM.swan); fly_now(); show(); });
  at("play").addEventListener("click", play);
  at("save-csv").addEventListener("click", () => { if (state.orbit) save("impacts.csv", "text/csv", csv()); });
  at("save-picture").addEventListener("click", () => save("oscillator.svg", "image/svg+xml", picture()));
  at("link").addEventListener("click", () => {
    location.replace(address());
    if (navigator.clipboard) navigator.clipboard.writeText(location.href).catch(() => {});
  });
  NIGHT.addEventListener("change", () => { legend(); show(); });
  const mark = (n, text, kind) => {
    const span = document.createElement("span");
    span.textContent = text; span.className = kind; span.style.left = `${100 * n / last}%`;
    at("places").append(span);
  };
  const beside = FILM.own !== null && FILM.own / last < 0.12, before = FILM.own !== null && FILM.own / last > 0.88;
  mark(0, beside || FILM.swan === 0 ? "" : short(FILM.frames[0].c, 4), "first");
  if (FILM.swan !== null) mark(FILM.swan, `c₀ = ${short(FILM.frames[FILM.swan].c, 5)}`, FILM.swan === 0 ? "swan first" : FILM.swan === last ? "swan last" : "swan");
  mark(last, before || FILM.swan === last ? "" : short(FILM.frames[last].c, 4), "last");
  if (FILM.own !== null && FILM.own !== 0 && FILM.own !== last) mark(FILM.own, "model", "own");
  if (MODEL.r_moves) back.push(slider("restitution", "restitution r", 0.01, 1, MODEL.r, (now) => { state.r = now; }));
  if (UPPER && UPPER.r_moves) back.push(slider("restitution-upper", "restitution at the upper wall", 0.01, 1, UPPER.r, (now) => { state.r_upper = now; }));
  Object.keys(MODEL.parameters).forEach((name, n) => {
    const value = MODEL.parameters[name], away = value === 0 ? 1 : 0.5 * Math.abs(value);
    back.push(slider(`parameter-${n}`, name, value - away, value + away, value, (now) => { state.given[name] = now; }));
  });
  at("reset").addEventListener("click", () => { back.forEach((each) => each()); fly_now(); show(); });
  if (!MODEL.period) at("period-option").remove();
  at("axes").addEventListener("change", show);
  const typed = () => {
    const [tau, v] = [at("start-tau"), at("start-v")].map((each) => each.value === "" ? NaN : Number(each.value));
    if (Number.isFinite(tau) && v >= 0) start_orbit(tau, v);
  };
  if (UPPER) at("wall").addEventListener("change", () => { state.wall = Number(at("wall").value); typed(); });
  else at("choice").remove();
  for (const id of ["start-tau", "start-v", "impacts"]) at(id).addEventListener("change", typed);
  at("forget").addEventListener("click", () => { state.start = state.orbit = null; show(); });
  at("states").addEventListener("click", (event) => {
    const corner = at("states").getBoundingClientRect(), here = PAGE_NOW.states, scale = here.wide / corner.width;
    const [tau, v] = here.data((event.clientX - corner.left) * scale, (event.clientY - corner.top) * scale);
    const { left, right } = here.box, px = (event.clientX - corner.left) * scale;
    if (px < left || px > right) return;
    start_orbit(Number(tau.toPrecision(6)), Math.max(0, Number(v.toPrecision(5))));
  });
  legend();
  let width = 0;
  new ResizeObserver(() => {
    if (width !== document.body.clientWidth) { width = document.body.clientWidth; show(); }
  }).observe(document.body);
  recall();
}
begin();
