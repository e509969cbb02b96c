// Colours of Okabe and Ito, with dashes as a second sign, and canvases that are sharp on any screen.
const seriesColours = {light: ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#a87400', '#3a9bd1', '#000000', '#7a5c99'],
                       dark: ['#56b4e9', '#ff8a3d', '#2fc79a', '#e59ac6', '#f0c04a', '#0f8fd6', '#ffffff', '#b79ad6']};
const dashes = [null, [7, 3], [2, 2], [9, 3, 2, 3], [4, 4], [12, 3], [2, 5], [6, 2, 2, 2, 2, 2]];
let palette = {};

const dark = () => getComputedStyle(page).colorScheme === 'dark';
function readPalette() {
  const style = getComputedStyle(page);
  palette = {dark: dark(), series: seriesColours[dark() ? 'dark' : 'light']};
  for (const name of ['card', 'ink', 'soft', 'line', 'faint', 'blue', 'red', 'green', 'body', 'edge', 'platform']) {
    palette[name] = style.getPropertyValue('--' + name).trim();
  }
}

// Context of a canvas with CSS pixels as its unit; null where it is not laid out.
function sharp(canvas) {
  const ratio = min(window.devicePixelRatio || 1, 2), width = canvas.clientWidth, height = canvas.clientHeight;
  if (!width || !height) return null;
  const w = round(width * ratio), h = round(height * ratio), context = canvas.getContext('2d');
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return {context, width, height, ratio};
}

function way(c, points) {
  c.beginPath();
  for (const p of points) c.lineTo(p[0], p[1]);
}

function line(c, points, colour, width = 1, dash = []) {
  way(c, points);
  c.strokeStyle = colour;
  c.lineWidth = width;
  c.setLineDash(dash);
  c.stroke();
  c.setLineDash([]);
}

function shape(c, points, fill) {
  way(c, points);
  c.fillStyle = fill;
  c.fill();
}

function disc(c, [x, y], radius, fill, stroke, width = 1) {
  c.beginPath();
  c.arc(x, y, radius, 0, 2 * PI);
  c.fillStyle = fill || 'transparent';
  c.fill();
  c.strokeStyle = stroke || 'transparent';
  c.lineWidth = width;
  c.stroke();
}

const font = ' 12px system-ui, sans-serif';
function note(c, text, x, y, colour, align = 'left', weight = '') {
  c.font = weight + font;
  c.textAlign = align;
  c.lineWidth = 3;
  c.strokeStyle = palette.card;
  c.strokeText(text, x, y);
  c.fillStyle = colour;
  c.fillText(text, x, y);
}

// 1, 2 or 5 times a power of ten, not above x.
function roundDown(x) {
  const power = 10 ** floor(log10(x)), digit = x / power;
  return (digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power;
}
