// Small pictures, one for each joint with play: its orbit, and load and wear around its bearing.
const cards = [];  // {canvas, back: the picture that does not change, paint, mark}

// Only cards on the screen are drawn.
const seen = new IntersectionObserver(entries => entries.forEach(e => {
  const card = cards.find(c => c.canvas === e.target);
  card.visible = e.isIntersecting;
  if (card.visible) drawCard(card);
}), {rootMargin: '200px'});

function drawCard({canvas, back, paint, mark}) {
  const surface = sharp(canvas);
  if (!surface) return;
  const {context, width, height, ratio} = surface, half = min(width, height) / 2, kind = canvas.width + (palette.dark ? ' dark' : '');
  const middle = c => c.setTransform(ratio, 0, 0, ratio, width / 2 * ratio, height / 2 * ratio);
  if (back.kind !== kind) {
    back.kind = kind;
    back.width = canvas.width;
    back.height = canvas.height;
    const c = back.getContext('2d');
    middle(c);
    c.lineJoin = 'round';
    paint(c, half);
  }
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(back, 0, 0);
  middle(context);
  if (mark) mark(context, half);
}
const drawCards = all => cards.forEach(card => { if (all || card.visible) drawCard(card); });

// `draw` gives caption, label, paint and mark of one of a list of each run.
function startCards(section, list, kind, draw) {
  const box = make('div', {class: 'cards'}), home = byId(section);
  if (home) home.append(box);
  for (const run of home ? runs.filter(r => r[list].length) : []) {
    box.append(make('h3', {}, titled(run)));
    for (const one of run[list]) {
      const {caption, label, paint, mark} = draw(run, one), canvas = make('canvas', {class: kind, role: 'img', 'aria-label': label + ' of ' + one.joint, data: {run: run.index, joint: one.joint}});
      cards.push({canvas, back: document.createElement('canvas'), paint, mark});
      const open = e => { if (e.key && e.key !== 'Enter') return; select(jointChannels(one.joint)); byId('plots').scrollIntoView(); };
      box.append(make('figure', {tabindex: 0, onclick: open, onkeydown: open}, canvas,
                         make('figcaption', {}, make('b', {}, one.joint), ...caption)));
      seen.observe(canvas);
    }
  }
}
const jointChannels = joint => ['fn', 'delta', 'vt', 'ft'].map(q => 'joint.' + joint + '.' + q);

function orbitCard(run, {joint, clearance, rows: rowText, points: pointText, radius}) {
  const rows = decode(rowText, Int32Array), points = decode(pointText), path = '/joints/' + escaped(joint) + '/clearance/radial_clearance';
  const at = (k, r) => [r * points[2 * k], -r * points[2 * k + 1]], indices = Array.from(rows.keys()), radii = radius && decode(radius), touches = k => (radii ? radii[k] : hypot(points[2 * k], points[2 * k + 1])) >= 1;
  const paint = (c, half) => {
    const r = half * 0.88;
    line(c, [[-half, 0], [half, 0]], palette.line);
    line(c, [[0, -half], [0, half]], palette.line);
    disc(c, [0, 0], r, null, palette.ink, 1.2);
    c.globalAlpha = 0.6;
    line(c, indices.map(k => at(k, r)), palette.blue, 0.7);
    c.globalAlpha = 1;
    c.fillStyle = palette.red;
    for (const k of indices.filter(touches)) c.fillRect(at(k, r)[0] - 1.5, at(k, r)[1] - 1.5, 3, 3);
  };
  const mark = (c, half) => {
    const k = lastUpTo(rows, run.row(clock.time)), p = at(k, half * 0.88);
    line(c, [[0, 0], p], palette.ink);
    disc(c, p, 5, touches(k) ? palette.red : palette.card, palette.ink, 2);
  };
  return {caption: [' ', run.get(path) ? shown(run, path, 'm', {class: 'soft'}) : quantity(clearance, 'm')], label: 'Orbit in the clearance circle', paint, mark};
}

// Polar histogram of 72 sectors; angle 0 is to the right, counted anticlockwise.
function bearingCard(run, {joint, work, pv_mean}) {
  const path = '/joints/' + escaped(joint) + '/play/', tables = [work, pv_mean].map(text => decode(text));
  const paint = (c, half) => {
    const inner = half * 0.3, room = half * 0.66, outline = numbers => {
      const top = max(...numbers.filter(isFinite), 1e-300), points = [];
      numbers.forEach((v, k) => [k, k + 1].forEach(edge => {
        const radius = inner + room * (v > 0 ? v / top : 0), angle = edge * PI / 36;
        points.push([radius * cos(angle), -radius * sin(angle)]);
      }));
      return [...points, points[0]];
    };
    disc(c, [0, 0], inner + room, null, palette.line);
    shape(c, outline(tables[0]), palette.body);
    line(c, outline(tables[0]), palette.blue, 1.2);
    if (tables[1].some(v => v > 0)) line(c, outline(tables[1]), palette.red, 1.3, [4, 3]);
    disc(c, [0, 0], inner, palette.card, palette.ink);
  };
  return {caption: [make('br'), shown(run, path + 'work', 'J'), make('br'), shown(run, path + 'pv_mean', 'Pa*m/s', {class: 'soft'})], label: 'Work of friction, and pressure times speed, by bearing angle', paint};
}
