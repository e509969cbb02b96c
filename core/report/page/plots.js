// Plots over time, zoomed together; which channels they show; their values at the cursor.
const chosen = new Set();
let graphs = [], sync = null;

const phrases = {__proto__: null, fn: 'Normal force', ft: 'Friction force', delta: 'Penetration', vt: 'Sliding speed', fx: 'Force, x', fy: 'Force, y', fz: 'Force, z', omega: 'Angular velocity'};
const parts = name => { const p = name.split('.'); return {kind: p[0], of: p.slice(1, -1).join('.'), what: p[p.length - 1]}; };
function phrase(name) {
  const {kind, what} = parts(name), words = phrases[what] || what[0].toUpperCase() + what.slice(1);
  return kind === 'joint' ? words : kind === 'driver' && /^e(x|y|angle)$/.test(what) ? 'Path error, ' + what.slice(1) : kind[0].toUpperCase() + kind.slice(1) + ': ' + words.toLowerCase();
}

const channelNames = [...new Set(runs.flatMap(r => r.channels.map(c => c.name)))];
const owners = name => runs.filter(r => r.named.has(name));
const unitOf = name => owners(name)[0].named.get(name).unit;
const peak = name => max(...owners(name).map(r => r.named.get(name)).map(c => max(abs(c.min), abs(c.max)) || 0));

// Points of a channel: rows where there are any, else a minimum and a maximum per bucket in the order that its course suggests.
function points(run, name) {
  const values = run.values(name), middle = k => values[2 * k] + values[2 * k + 1], last = run.buckets - 1, all = [];
  if (!run.buckets) return [run.times, values];
  for (let k = 0; k <= last; ++k) {
    const t = run.times[k], next = run.times[k + 1], falls = middle(min(k + 1, last)) < middle(max(k - 1, 0));
    all.push([t, values[2 * k + falls]]);
    if (next > t) all.push([k === last ? next : (t + next) / 2, values[2 * k + !falls]]);
  }
  // Around the largest impacts rows take the place of buckets.
  const windows = run.windows.filter(w => Object.hasOwn(w.channels, name)).map(({times, channels: {[name]: c}}) => [decode(times, Float64Array), decode(c.values).map(v => v + c.offset)]);
  const list = all.filter(([x]) => !windows.some(([ts]) => x >= ts[0] && x <= ts[ts.length - 1])).concat(windows.flatMap(([ts, ys]) => Array.from(ts, (t, i) => [t, ys[i]])));
  list.sort((a, b) => a[0] - b[0]);
  return [0, 1].map(i => list.map(p => p[i]));
}

// Rows of dygraphs for several curves with instants of their own.
function merged(curves) {
  const times = [...new Set(curves.flatMap(([xs]) => Array.from(xs)))].sort((a, b) => a - b), at = new Map(times.map((t, k) => [t, k]));
  const rows = times.map(t => [t, ...curves.map(() => null)]);
  curves.forEach(([xs, ys], s) => xs.forEach((x, k) => { rows[at.get(x)][s + 1] = ys[k]; }));
  return rows;
}

function swatch(k) {
  const e = make('i');
  e.innerHTML = '<svg viewBox="0 0 26 8" aria-hidden="true"><path d="M0 4h26" stroke="' + palette.series[k % 8] + '" stroke-width="2.5" stroke-dasharray="' + (dashes[k % 8] || '') + '"/></svg>';
  return e.firstChild;
}

// A plot with its heading, and a place for a value of each curve; `signs` are the colours and dashes of the curves.
function addPlot(home, title, labels, curves, options) {
  const values = labels.map(() => make('span', {class: 'soft'})), keys = labels.map((_, k) => 's' + k), {signs = [...labels.keys()]} = options;
  const head = make('figcaption', {}, make('b', {}, title), ...labels.map((label, k) => span(swatch(signs[k]), label + ' ', values[k])));
  const plot = make('div', {class: options.logscale ? 'spectrum' : 'plot', role: 'img', 'aria-label': title});
  home.append(make('figure', {}, head, plot));
  const look = () => ({colors: signs.map(k => palette.series[k % 8]), axisLineColor: palette.soft, gridLineColor: palette.line});
  const graph = new Dygraph(plot, merged(curves), {
    labels: ['x', ...keys], ...look(), series: Object.fromEntries(keys.map((key, k) => [key, {strokePattern: dashes[signs[k] % 8]}])),
    strokeWidth: 1.3, axisLabelFontSize: 12, legend: 'never', connectSeparatedPoints: true,
    highlightCallback: (_, x, at) => at.forEach(p => { values[+p.name.slice(1)].textContent = options.say(p.yval); }),
    unhighlightCallback: () => values.forEach(v => { v.textContent = ''; }), ...options
  });
  graph.dye = () => {
    head.querySelectorAll('path').forEach((e, k) => e.setAttribute('stroke', palette.series[signs[k] % 8]));
    graph.updateOptions(look());
  };
  return graph;
}
const axis = (write, width, room) => ({axisLabelFormatter: write, axisLabelWidth: width, pixelsPerLabel: room});
// Digits that tell round numbers between two values apart.
const digits = (a, b) => min(15, max(6, 3 + log10(max(abs(a), abs(b)) / (b - a || Infinity))));
const tidy = (s, range, unit = '') => (v, _, options, g) => minus(String(+(v / 10 ** s.power).toPrecision(digits(...g[range]())))) + unit;

function addGraph(home, title, names) {
  const series = names.flatMap(name => owners(name).map(run => ({run, name}))), unit = unitOf(names[0]), s = scale(max(...names.map(peak)), unit);
  const ends = series.flatMap(({run, name}) => [run.named.get(name).min, run.named.get(name).max]), width = 10 + 7 * digits(min(...ends), max(...ends));
  const label = ({run, name}) => {
    const {of, what} = parts(name), {missing} = run.named.get(name);
    return [titled(run), of || what, missing && '(' + missing + ' of ' + run.rows + ' rows without a number)'].filter(Boolean).join(' ');
  };
  const graph = addPlot(home, title + (s.unit && ' [' + s.unit + ']'), series.map(label), series.map(({run, name}) => points(run, name)), {
    say: v => quantity(v, unit), dateWindow: [...clock.range], axes: {x: axis(tidy(clockScale, 'xAxisRange', '\u00a0' + clockScale.unit), 76, 84), y: axis(tidy(s, 'yAxisRange'), width, 28)},
    clickCallback: (_, t) => seek(t), drawCallback: g => { clock.range = g.xAxisRange(); moveCursors(clock.time); },
    underlayCallback: (c, area, g) => {  // what does not count
      const from = runs[0].get('/statistics/from'), x = from > timeStart ? min(g.toDomXCoord(from), area.x + area.w) : area.x;
      c.fillStyle = palette.faint;
      if (x > area.x) c.fillRect(area.x, area.y, x - area.x, area.h);
    }
  });
  graph.line = make('div', {class: 'cursor'});
  graph.graphDiv.append(graph.line);
  graphs.push(graph);
}

function moveCursors(t) {
  for (const g of graphs) {
    const x = g.toDomXCoord(t), area = g.getArea();
    g.line.hidden = x < area.x - 0.5 || x > area.x + area.w + 0.5;
    g.line.style.transform = 'translateX(' + x + 'px)';
    g.line.style.height = area.h + 'px';
  }
}

// Channels that mean the same of different elements share a plot, eight curves at most.
const most = max(1, floor(8 / runs.length));
function drawGraphs() {
  if (sync) sync.detach();
  for (const g of [...graphs, ...spectra]) g.destroy();
  graphs = [];
  const groups = new Map(), energy = document.querySelector('#energy .graph'), home = byId('graphs');
  for (const name of chosen) {
    const {kind, what} = parts(name), key = what + kind + unitOf(name);
    groups.set(key, [...(groups.get(key) || []), name]);
  }
  home.replaceChildren();
  for (const names of groups.values()) for (let k = 0; k < names.length; k += most) addGraph(home, phrase(names[0]), names.slice(k, k + most));
  if (energy) {
    energy.replaceChildren();
    const names = channelNames.filter(n => n.startsWith('energy.')).slice(0, most);
    if (names.length) addGraph(energy, 'Over time', names);
  }
  sync = graphs.length > 1 ? Dygraph.synchronize(graphs, {zoom: true, selection: false, range: false}) : null;
  drawSpectra();
}

function zoom(from, until) {
  clock.range = [from, until];
  if (graphs.length) graphs[0].updateOptions({dateWindow: [from, until]});
}
const unzoom = () => zoom(timeStart, timeEnd);

function select(names) {
  chosen.clear();
  for (const name of names) if (channelNames.includes(name)) chosen.add(name);
  drawGraphs();
  drawNow();
  for (const box of document.querySelectorAll('#choice input')) box.checked = chosen.has(box.value);
  byId('chosen').textContent = '(' + chosen.size + ' of ' + channelNames.length + ')';
}

// The table of values at the cursor.
let cells = [];
function drawNow() {
  cells = [];
  const lines = [...chosen].map(name => row(name, ...runs.map(run => {
    if (!run.named.has(name)) return right('–');
    const e = make('span', {data: {run: run.index, channel: name}});
    cells.push({e, run, name});
    return right(e);
  })));
  byId('now').replaceChildren(...table(['Channel', ...runs.map(r => right(titled(r) || 'at the cursor'))], lines).childNodes);
  fillNow(clock.time);
}
function fillNow(t) {
  for (const {e, run, name} of cells) {
    const v = run.value(name, t), {unit} = run.named.get(name);
    if (run.buckets) [e.dataset.low, e.dataset.high] = v; else e.dataset.value = v;
    e.textContent = quantity(run.buckets && v[0] === v[1] ? v[0] : v, unit);
  }
}

// Choices of channels that answer common questions.
function presets() {
  const like = pattern => channelNames.filter(n => pattern.test(n)), largest = names => [...names].sort((a, b) => peak(b) - peak(a)).slice(0, most).sort((a, b) => channelNames.indexOf(a) - channelNames.indexOf(b));
  const lists = {'Contact forces': largest(like(/^joint\..*\.fn$/)), Drivers: like(/^driver\..*\.(torque|force)$/).slice(0, most), 'Path errors': like(/^driver\..*\.e(x|y|angle)$/),
                 Sliding: largest(like(/^joint\..*\.vt$/)), Penetration: largest(like(/^joint\..*\.delta$/)), Bodies: like(/^body\.[^.]*\.(x|y|z|angle)$/).slice(0, 6)};
  return Object.fromEntries(entries(lists).filter(([, names]) => names.length));
}

function startChoice() {
  const box = byId('choice'), toggled = ({target: {checked, value}}) => { checked ? chosen.add(value) : chosen.delete(value); select([...chosen]); };
  byId('channels').addEventListener('toggle', () => box.append(...channelNames.map(name =>
    make('label', {}, make('input', {type: 'checkbox', value: name, checked: chosen.has(name), onchange: toggled}), name))), {once: true});
  byId('search').oninput = e => {
    const words = e.target.value.toLowerCase().split(/\s+/);
    for (const label of box.children) label.hidden = !words.every(w => label.textContent.toLowerCase().includes(w));
  };
}

function startPlots() {
  const lists = presets(), coarse = runs.filter(r => r.buckets);
  byId('presets').append(...entries(lists).map(([title, names]) => make('button', {onclick: () => select(names)}, title)));
  byId('unzoom').onclick = unzoom;
  startChoice();
  byId('coarse').textContent = [
    coarse.length && 'Drawn are the smallest and the largest value of every ' + ceil(max(...coarse.map(r => r.rows / r.buckets))) + ' rows, and all rows around the largest impacts.',
    ...runs.filter(r => r.start <= r.get('/statistics/from') && r.end >= r.get('/time/reached')).flatMap(r => entries(r.get('/joints')).flatMap(([name, {max_fn}]) => {
      const fn = r.named.get('joint.' + name + '.fn');
      return fn && max_fn > 1.1 * fn.max ? [titled(r) + ' Rows miss peaks between them: of ' + name + ' they show ' + quantity(fn.max, 'N') + ' of ' + quantity(max_fn, 'N') + '.'] : [];
    }).slice(0, 1)),
    ...runs.filter(r => r.left_out.length).map(r => titled(r) + ' has no room for ' + r.left_out.slice(0, 5).join(', ') + (r.left_out.length > 5 ? ' and ' + (r.left_out.length - 5) + ' more.' : '.'))
  ].filter(Boolean).join(' ');
  const counted = min(...runs.map(r => r.get('/statistics/from') || timeStart));
  if (counted > timeStart && counted < timeEnd) clock.range = [counted, timeEnd];
  const first = ['Contact forces', 'Path errors', 'Drivers'].flatMap(t => lists[t] || []);
  select(first.length ? first : Object.values(lists)[0] || channelNames.slice(0, 3));
  onTime(t => { moveCursors(t); fillNow(t); });
}

// Spectra stand apart: their axis is frequency.
let spectra = [];
function drawSpectra() {
  const box = document.querySelector('#spectra .spectra');
  spectra = [];
  if (box) box.replaceChildren();
  for (const name of box ? new Set(runs.flatMap(r => r.spectra.map(s => s.name))) : []) {
    const series = runs.map(run => ({run, s: run.spectra.find(s => s.name === name)})).filter(x => x.s), unit = series[0].s.unit;
    const curves = series.map(({s}) => [decode(s.frequency), decode(s.amplitude).map(v => v || 1e-30)]), top = max(...curves.flatMap(c => [...c[1]].filter(isFinite)));
    const y = scale(top, unit), decades = [-5, -4, -3, -2, -1, 0, 1, 2, 3].map(k => ({v: 10 ** (k + y.power), label: plain(10 ** k, 2)}));
    spectra.push(addPlot(box, parts(name).of + ', ' + parts(name).what + ' [' + y.unit + ']', series.map(({run}) => titled(run)), curves,
      {say: v => quantity(v, unit), signs: series.map(({run}) => run.index), logscale: true, valueRange: [top * 1e-5, top * 2], axes: {x: axis(v => quantity(v, 'Hz'), 66, 84), y: {ticker: () => decades, axisLabelWidth: 52}}}));
  }
}
