// The data of the page: numbers in base64, made into what the rest draws.
const {abs, ceil, cos, floor, hypot, log10, max, min, round, sin, PI} = Math, page = document.documentElement;
const byId = id => document.getElementById(id), data = JSON.parse(byId('freeplay-data').textContent);

function decode(text, Type = Float32Array) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return new Type(bytes.buffer);
}

// Index of the last of some growing numbers that is not above `value`, at least 0.
function lastUpTo(numbers, value, count = numbers.length) {
  let low = 0, high = count - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (numbers[middle] <= value) low = middle; else high = middle - 1;
  }
  return low;
}
function nearest(numbers, value) {
  const k = lastUpTo(numbers, value);
  return numbers[k + 1] - value < value - numbers[k] ? k + 1 : k;
}

class Run {
  constructor(raw, index) {
    Object.assign(this, raw);
    this.index = index;
    this.title = raw.name;
    this.times = decode(raw.times, Float64Array);
    this.start = this.times[0];
    this.end = this.times[this.times.length - 1];
    this.named = new Map(raw.channels.map(c => [c.name, c]));
    this.decoded = new Map();
  }

  // A part of the summary by its JSON pointer.
  get(path) {
    return path.split('/').slice(1).reduce((part, key) => part && part[key.replace(/~1/g, '/').replace(/~0/g, '~')], this.summary);
  }

  // What stands for a channel: a minimum and a maximum per bucket, or a number per row. What is as small as the rounding is 0.
  values(name) {
    if (!this.decoded.has(name)) {
      const c = this.named.get(name), rounding = 6e-8 * (c.max - c.min);
      this.decoded.set(name, Float64Array.from(decode(c.values), v => abs(c.offset + v) < rounding ? 0 : max(c.min, min(c.max, c.offset + v))));
    }
    return this.decoded.get(name);
  }

  // Bucket, or row where each has its number, at a time.
  place(t) {
    return this.buckets ? lastUpTo(this.times, t, this.buckets) : nearest(this.times, t);
  }

  value(name, t) {
    if (!this.named.has(name)) return null;
    const values = this.values(name), k = this.place(t);
    return this.buckets ? [values[2 * k], values[2 * k + 1]] : values[k];
  }

  // Row at a time; between the ends of a bucket rows are taken as evenly spaced.
  row(t) {
    if (!this.buckets) return this.place(t);
    const k = this.place(t), first = i => floor(i * this.rows / this.buckets);
    const begin = first(k), end = k + 1 < this.buckets ? first(k + 1) : this.rows - 1;
    const length = this.times[k + 1] - this.times[k];
    return round(begin + (length > 0 ? (end - begin) * min(1, (t - this.times[k]) / length) : 0));
  }
}

const runs = data.runs.map((raw, index) => new Run(raw, index));
const several = runs.length > 1, titled = run => several ? run.title : '';  // where there is but one it needs no name
const timeStart = min(...runs.map(r => r.start)), timeEnd = max(...runs.map(r => r.end));

const escaped = key => key.replace(/~/g, '~0').replace(/\//g, '~1');
