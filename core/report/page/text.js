// Elements, and numbers as people read them.
function make(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'data') Object.assign(e.dataset, value);
    else if (name.startsWith('on')) e.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== false) e.setAttribute(name, value === true ? '' : value);
  }
  e.append(...children.filter(c => c != null));
  return e;
}

const span = (...children) => make('span', {}, ...children), entries = part => Object.entries(part || {});

const minus = text => text.replace('-', '−');

function plain(x, digits = 4) {
  if (x === 0) return '0';
  const size = abs(x);
  return minus(size >= 1e6 || size < 1e-4 ? x.toExponential(digits - 2).replace('e+', 'e') : String(+x.toPrecision(digits)));
}

const prefixes = {'-12': 'p', '-9': 'n', '-6': 'µ', '-3': 'm', 0: '', 3: 'k', 6: 'M', 9: 'G'};
const people = unit => unit.replace(/\*/g, '·');

// Power of ten and unit that suit numbers of this size.
function scale(size, unit) {
  if (unit === '1' || !unit || (size > 0 && size < 1e-12)) return {power: 0, unit: unit === '1' ? '' : people(unit)};
  const power = size > 0 && isFinite(size) ? max(-12, min(9, 3 * floor(log10(size * 1.0000001) / 3))) : 0;
  return {power, unit: prefixes[power] + people(unit)};
}

// A number, or a range.
function quantity(x, unit, digits) {
  const ends = [x].flat();
  if (ends.some(v => v == null || Number.isNaN(v))) return '–';
  const s = scale(max(...ends.map(abs)), unit);
  return ends.map(v => plain(v / 10 ** s.power, digits)).join(' … ') + (s.unit && '\u00a0' + s.unit);
}

const percent = x => x == null ? '–' : plain(100 * x, 3) + '\u00a0%';
const instant = t => quantity(t, 's', 5);

// A number of a summary, in an element that says which.
function shown(run, path, write = String, attributes = {}) {
  const value = run.get(path);
  if (typeof value !== 'number') return span(value || '–');
  const text = typeof write === 'function' ? write(value) : quantity(value, write);
  return make('span', {...attributes, data: {run: run.index, path, value: String(value)}}, text);
}

// The same with the scatter that impacts leave on it, where the run knows it.
function scattered(run, path, unit) {
  const spread = '/repeat' + path, [median, least, most] = ['/median', '/min', '/max'].map(end => shown(run, spread + end, unit));
  if (run.get(spread + '/median') != null) return span(median, ' (', least, ' to ', most, ' in ' + run.summary.repeat.completed + ' runs)');
  const noise = '/noise' + path, by = run.get(noise), value = run.get(path);
  const e = span(shown(run, path, by > 0 ? v => quantity(v, unit, max(2, min(4, 2 + floor(log10(abs(value) / by))))) : unit));
  if (by > 0) e.append(' ±\u00a0', shown(run, noise, v => quantity(v, unit, 2), {class: 'soft', title: 'scatter by chance of impacts'}));
  return e;
}

// Cells are texts, elements, or {number: either}.
const content = c => c && c.number !== undefined ? c.number : c;
const cell = (c, tag = 'td') => make(tag, {class: c !== content(c) ? 'number' : '', scope: tag === 'th' && 'row'}, content(c));
const row = (first, ...cells) => make('tr', {}, cell(first, 'th'), ...cells.map(c => cell(c)));
const table = (head, ...bodies) => make('table', {}, make('thead', {}, make('tr', {}, ...head.map(h => make('th', {scope: 'col', class: h !== content(h) ? 'number' : ''}, content(h))))),
                                           ...bodies.filter(rows => rows.length).map(rows => make('tbody', {}, ...rows)));

function copy(text, button) {
  navigator.clipboard.writeText(text).then(() => { button.textContent = 'Copied'; });
}
