// The mechanism in motion: one cell of the canvas for each run, all at one scale.
const scene = {canvas: byId('scene'), motions: [], yaw: -0.6, pitch: 0.35, exaggerate: 1, places: new Map()};
const flashSeconds = 0.25;  // on the screen

function startScene() {
  if (!scene.canvas) return;
  scene.motions = runs.filter(r => r.animation).map(r => new Motion(r));
  scene.spatial = scene.motions.some(m => m.spatial);
  scene.canvas.setAttribute('aria-label', 'In motion: ' + document.title);
  const sizes = scene.motions.flatMap(m => m.joints.filter(j => j.forces.length).map(j => {
    const n = m.spatial ? 3 : 2, all = Array.from({length: j.forces.length / n}, (_, k) => hypot(...j.forces.subarray(n * k, n * k + n)));
    return all.filter(isFinite).sort((a, b) => a - b)[floor(all.length * 0.9)] || 0;
  }));
  scene.newton = roundDown(max(...sizes, 1e-9));
  byId('forces').closest('label').hidden = !sizes.length;
  const loose = scene.motions.flatMap(m => [...m.offsets.keys()]);
  byId('magnified').hidden = !loose.length;
  const marks = scene.motions.flatMap(m => m.marks.map(x => x.name)), bodies = scene.motions.flatMap(m => m.bodies.map(b => b.name));
  byId('trace').append(make('option', {value: ''}, 'none'), ...[...new Set([...marks, ...bodies])].map(n => make('option', {value: n}, n)));
  const setTrace = name => { for (const m of scene.motions) m.traced = name ? m.path(name) : null; };
  setTrace(byId('trace').value = marks[0] || '');
  byId('trace').onchange = e => { setTrace(e.target.value); drawScene(); };
  byId('exaggerate').oninput = e => exaggerate(+e.target.value);
  byId('labels').checked = max(...scene.motions.map(m => m.joints.length)) <= 16;
  for (const option of ['forces', 'labels']) byId(option).onchange = drawScene;
  fit();
  exaggerate(2 ** floor(Math.log2(max(1, 20 / (max(...loose.map(j => j.clearance)) * scene.scale)))));  // circles that can be seen
  if (scene.spatial) turnable();
  onTime(drawScene);
  new ResizeObserver(() => { fit(); drawScene(); }).observe(scene.canvas);
}

function exaggerate(factor) {
  scene.exaggerate = max(1, min(1000, factor || 1));
  byId('exaggerate').value = scene.exaggerate;
  byId('factor').textContent = '×' + plain(scene.exaggerate, 3);
  drawScene();
}
function changeExaggeration(factor) {
  if (scene.canvas) exaggerate(scene.exaggerate * factor);
}

// Cells and the scale that holds the whole motion of every run.
function fit() {
  const n = scene.motions.length, width = scene.canvas.clientWidth || 600;
  const columns = min(n, width < 480 ? 1 : n <= 4 ? 2 : n <= 6 ? 3 : 4), rows = ceil(n / columns);
  scene.canvas.style.height = (rows > 1 ? 280 * rows : width < 480 ? 330 : 470) + 'px';
  const w = width / columns, h = scene.canvas.clientHeight / rows;
  scene.cells = scene.motions.map((m, k) => ({x: w * (k % columns), y: h * floor(k / columns), w, h}));
  scene.scale = min(...scene.motions.map(m => {
    const size = m.low.map((l, i) => m.high[i] - l), round = hypot(...size), [x, y] = m.spatial ? [round, round * 0.9] : size;
    return min((w - 80) / (x || 1e-9), (h - 90) / (y || 1e-9));
  }));
}

// Place on the canvas of a point, and its depth towards the eye.
function projection(m, cell) {
  const middle = m.low.map((l, i) => (l + m.high[i]) / 2), cx = cell.x + cell.w / 2, cy = cell.y + cell.h / 2 + 4, s = scene.scale;
  if (!m.spatial) return p => [cx + s * (p[0] - middle[0]), cy - s * (p[1] - middle[1]), 0];
  const turned = view();
  return p => {
    const [x, y, z] = turned(p.map((v, i) => v - middle[i]));
    return [cx + s * x, cy + s * y, z];
  };
}
function view() {
  const ca = cos(scene.yaw), sa = sin(scene.yaw), cb = cos(scene.pitch), sb = sin(scene.pitch);
  return ([x, y, z]) => [ca * x + sa * y, -cb * z - sb * (ca * y - sa * x), sb * z - cb * (ca * y - sa * x)];
}

function drawScene() {
  const surface = scene.canvas && sharp(scene.canvas);
  if (!surface) return;
  ++clock.drawn;
  const c = surface.context;
  c.fillStyle = palette.card;
  c.fillRect(0, 0, surface.width, surface.height);
  c.lineJoin = c.lineCap = 'round';
  scene.motions.forEach((m, k) => {
    const cell = scene.cells[k], {x, y, w, h} = cell;
    c.save();
    c.beginPath();
    c.rect(x, y, w, h);
    c.clip();
    m.moveTo(clock.time);
    drawRun(c, m, cell);
    c.restore();
    if (x) line(c, [[x, y], [x, y + h]], palette.line);
    if (y) line(c, [[x, y], [x + w, y]], palette.line);
  });
}

function drawRun(c, m, cell) {
  const project = projection(m, cell), joints = m.joints.map(joint => {
    const first = m.world(joint.first, joint.at_first), second = m.world(joint.second, joint.at_second);
    return {joint, first, second, p: project(first), q: project(second)};
  });
  for (const {joint, p, q} of joints) {
    if (['tie', 'rod', 'slide'].includes(joint.symbol)) drawTie(c, p, q, joint.symbol === 'tie');
    else if (joint.first < 0 || joint.second < 0) drawGround(c, joint.first < 0 ? p : q);
  }
  const bodies = m.bodies.map((b, k) => {
    const points = b.points.map(p => project(m.world(k, p)));
    return {points: hull(points), many: points.length > 2, depth: m.spatial ? points.reduce((sum, p) => sum + p[2], 0) / points.length : -(points.length > 2)};
  }).sort((a, b) => a.depth - b.depth);
  for (const {points, many} of bodies) {
    const closed = [...points, points[0]], colour = many ? palette.platform : palette.body;
    line(c, closed, palette.edge, 11);
    line(c, closed, colour, 8.5);
    shape(c, points, colour);
  }
  if (m.traced) {
    const points = m.traced.map(project);
    line(c, points, palette.green, 1.2, [2, 4]);
    line(c, points.slice(0, m.frame + 1), palette.green, 2);
  }
  for (const j of joints) drawJoint(c, m, j, project);
  if (byId('forces').checked) for (const j of joints) drawForce(c, m, j, project);
  drawNotes(c, m, cell);
  if (byId('labels').checked) drawNames(c, m, joints, cell);
}

function hull(points) {
  const half = list => {
    const out = [];
    for (const p of list) {
      while (out.length > 1) {
        const a = out[out.length - 2], b = out[out.length - 1];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        out.pop();
      }
      out.push(p);
    }
    return out.slice(0, -1);
  };
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}

function drawGround(c, [x, y]) {
  const foot = [[x, y], [x - 9, y + 15], [x + 9, y + 15]];
  shape(c, foot, palette.faint);
  line(c, [...foot, foot[0]], palette.edge, 1.5);
  for (let k = -9; k <= 9; k += 4.5) line(c, [[x + k + 2, y + 15], [x + k - 2, y + 20]], palette.edge);
}

const from = (p, q) => [q[0] - p[0], q[1] - p[1]];

function drawTie(c, p, q, spring) {
  const d = from(p, q), length = hypot(...d) || 1, at = k => {
    const side = spring && k > 0 && k < 12 ? (k % 2 ? 5 : -5) / length : 0;
    return [p[0] + k / 12 * d[0] - side * d[1], p[1] + k / 12 * d[1] + side * d[0]];
  };
  line(c, Array.from({length: 13}, (_, k) => at(k)), palette.edge, spring ? 1.4 : 3);
}

function drawJoint(c, m, {joint, p, q, first, second}, project) {
  const {symbol} = joint;
  if (joint.clearance) return drawClearance(c, m, joint, p, first, project);
  if (symbol === 'tie' || symbol === 'force') return;
  c.fillStyle = palette.edge;
  if (symbol === 'weld') return c.fillRect(p[0] - 4, p[1] - 4, 8, 8);
  if (symbol !== 'slide') return disc(c, p, 4.2, palette.card, palette.edge, 1.6);
  const d = m.direction(joint.first, joint.axis), rod = (from, px) => [1, -1].map(s => project(from.map((x, i) => x + s * px / scene.scale * d[i])));
  if (joint.first < 0) line(c, rod(second, 60), palette.edge, 1.4);
  c.lineCap = 'butt';
  line(c, rod(second, 12), palette.edge, 15);
  line(c, rod(second, 10.5), palette.card, 12);
  c.lineCap = 'round';
  disc(c, q, 2, palette.edge);
}

// The bearing as a circle of its clearance, the journal's centre in it, both larger about the joint.
function drawClearance(c, m, joint, p, first, project) {
  const factor = scene.exaggerate, radius = joint.clearance * scene.scale * factor, e = m.offset(joint), shown = max(radius, 4.5);
  const touching = hypot(...e) >= joint.clearance * 0.99999, at = project(first.map((x, i) => x + factor * e[i])), flash = m.flash(joint);
  if (flash > 0) disc(c, p, shown + 5 + 16 * (1 - flash), null, palette.red, 1 + 3 * flash);
  c.globalAlpha = 0.88;
  disc(c, p, shown, palette.card, touching ? palette.red : palette.edge, touching ? 2.6 : 1.4);
  c.globalAlpha = 1;
  if (radius < 2) return disc(c, p, 1.8, palette.edge);
  line(c, [p, at], palette.soft);
  disc(c, at, 3.2, touching ? palette.red : palette.card, touching ? palette.ink : palette.edge, 1.4);
}

function arrow(c, p, tip, colour) {
  const [x, y] = from(p, tip), b = min(8 / hypot(x, y), 0.5), back = (along, aside) => [tip[0] - b * (along * x + aside * y), tip[1] - b * (along * y - aside * x)];
  line(c, [p, back(0.7, 0)], colour, 2);
  shape(c, [tip, back(1, 0.45), back(1, -0.45)], colour);
}

// Force on the second body; what would leave the picture is cut and has its number.
function drawForce(c, m, {joint, q, second}, project) {
  if (!joint.forces.length) return;
  const f = m.force(joint), px = hypot(...f) * 60 / scene.newton, cut = min(1, 170 / px);
  if (!(px > 4)) return;
  const tip = project(second.map((x, i) => x + cut * 60 / scene.newton / scene.scale * f[i]));
  if (hypot(...from(q, tip)) < 2) return;
  arrow(c, q, tip, palette.blue);
  if (cut < 1) note(c, quantity(hypot(...f), 'N', 3), tip[0] + 5, tip[1] - 5, palette.blue);
}

// Scale bar, key of the arrows, name of the run, axes in space.
function drawNotes(c, m, cell) {
  const y = cell.y + cell.h - 14, x = cell.x + 16, length = roundDown(110 / scene.scale), px = length * scene.scale, right = cell.x + cell.w;
  line(c, [[x, y - 4], [x, y], [x + px, y], [x + px, y - 4]], palette.ink, 1.5);
  note(c, quantity(length, 'm'), x + px / 2, y - 6, palette.ink, 'center');
  if (byId('forces').checked) {
    arrow(c, [right - 84, y], [right - 24, y], palette.blue);
    note(c, quantity(scene.newton, 'N'), right - 54, y - 8, palette.blue, 'center');
  }
  note(c, titled(m.run), x, cell.y + 22, palette.ink, 'left', '600');
  if (!m.spatial) return;
  const turned = view(), at = [right - 42, cell.y + 46];
  ['x', 'y', 'z'].forEach((name, k) => {
    const [dx, dy] = turned([0, 1, 2].map(i => i === k ? 1 : 0));
    line(c, [at, [at[0] + 22 * dx, at[1] + 22 * dy]], palette.soft, 1.4);
    note(c, name, at[0] + 31 * dx, at[1] + 31 * dy + 4, palette.soft, 'center');
  });
}

// Names where they cover neither joints nor each other; each keeps its side as long as it can, so that none jumps about.
function drawNames(c, m, joints, {x, y, w, h}) {
  const meets = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3], sides = [[1, -1], [1, 1], [-1, -1], [-1, 1], [0, -1.3], [0, 1.3]];
  const taken = [...joints.map(({p}) => [p[0] - 6, p[1] - 6, p[0] + 6, p[1] + 6]), [x, y, x + (several ? 150 : 0), y + 30], [x, y + h - 34, x + 150, y + h]];
  c.font = font;
  for (const {joint, p} of joints) {
    const key = m.run.index + joint.name, width = c.measureText(joint.name).width, r = 4 + 0.75 * max(7, (joint.clearance || 0) * scene.scale * scene.exaggerate);
    const boxes = sides.map(([sx, sy]) => {
      const left = p[0] + sx * r - (sx < 0 ? width : sx ? 0 : width / 2), base = p[1] + sy * r + 4;
      return [left, base - 10, left + width, base + 3];
    });
    const free = b => b[0] > x + 2 && b[2] < x + w - 2 && b[1] > y + 2 && !taken.some(t => meets(b, t));
    const side = [scene.places.get(key) || 0, 0, 1, 2, 3, 4, 5].find(s => free(boxes[s]));
    if (side === undefined) continue;
    scene.places.set(key, side);
    taken.push(boxes[side]);
    note(c, joint.name, boxes[side][0], boxes[side][3] - 3, palette.soft);
  }
}

// Drag and arrow keys turn the view of a spatial mechanism.
function turnable() {
  const {canvas} = scene, turn = (dx, dy) => {
    scene.yaw += dx;
    scene.pitch = max(-PI / 2, min(PI / 2, scene.pitch + dy));
    drawScene();
  };
  let from = null;
  canvas.classList.add('spatial');
  canvas.onpointerdown = e => { from = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); };
  canvas.onpointermove = e => {
    if (!from) return;
    turn((from[0] - e.clientX) * 0.008, (e.clientY - from[1]) * 0.008);
    from = [e.clientX, e.clientY];
  };
  canvas.onpointerup = canvas.onpointercancel = () => { from = null; };
  canvas.onkeydown = e => {
    const by = {ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[e.key];
    if (!by || e.shiftKey) return;
    turn(...by);
    e.preventDefault();
    e.stopPropagation();
  };
}
