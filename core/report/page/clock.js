// The instant that everything shows: frames of the animation, playing, and who listens.
const clock = {time: timeStart, playing: false, speed: 1, drawn: 0, range: [timeStart, timeEnd]};
const listeners = [], onTime = listener => listeners.push(listener);
const frameTimes = runs.map(r => r.animation ? decode(r.animation.times, Float64Array) : r.times), frames = frameTimes[0];
const clockScale = scale(max(abs(timeStart), abs(timeEnd)), 's');
const clockDigits = max(0, min(9, ceil(4 - log10((timeEnd - timeStart) / 10 ** clockScale.power || 1))));

function show(t) {
  clock.time = t;
  for (const listener of listeners) listener(t);
}
function seek(t) {
  pause();
  show(frames[nearest(frames, t)]);
  return clock.time;
}
// Frames on or back from the present one; an instant between two frames counts as the one before it.
function stepFrames(by) {
  const slack = 1e-9 * (timeEnd - timeStart), k = lastUpTo(frames, clock.time + slack), between = by < 0 && clock.time > frames[k] + slack;
  seek(frames[max(0, min(frames.length - 1, k + by + between))]);
}

let before = null;
function tick(now) {
  if (!clock.playing) return;
  const [from, until] = clock.range, t = clock.time + (before === null ? 0 : min(now - before, 100) / 1000 * clock.speed);
  before = now;
  show(t > until || t < from ? from : t);
  requestAnimationFrame(tick);
}
function setPlaying(playing) {
  if (playing && !clock.playing) { before = null; requestAnimationFrame(tick); }
  clock.playing = playing;
  const button = byId('play');
  if (button) { button.textContent = playing ? 'Pause' : 'Play'; button.setAttribute('aria-pressed', playing); }
}
const play = () => setPlaying(timeEnd > timeStart), pause = () => setPlaying(false), toggle = () => setPlaying(!clock.playing);

// Speeds in the series 1, 2, 5 about the one at which a run lasts ten seconds.
const speeds = [-5, -4, -3, -2, -1, 0, 1].flatMap(power => [1, 2, 5].map(digit => +(digit * 10 ** power).toPrecision(1)));
function setSpeed(speed) {
  clock.speed = speed;
  if (byId('speed')) byId('speed').value = speed;
}
const changeSpeed = by => setSpeed(speeds[max(0, min(speeds.length - 1, speeds.indexOf(clock.speed) + by))]);

const impactTimes = runs.flatMap(r => r.events.rows.map(e => e[0])).sort((a, b) => a - b);
function stepImpact(by) {
  const half = 0.51 * (frames[1] - frames[0] || 0), t = by > 0 ? impactTimes.find(e => e > clock.time + half) : impactTimes.filter(e => e < clock.time - half).pop();
  if (t !== undefined) seek(t);
}

function startClock() {
  const scrub = byId('scrub');
  if (scrub) {
    byId('speed').append(...speeds.map(s => make('option', {value: s}, s + '×')));
    byId('speed').onchange = e => setSpeed(+e.target.value);
    byId('play').onclick = toggle;
    [['earlier', -1], ['later', 1]].forEach(([id, by]) => { byId(id).onclick = () => stepImpact(by); byId(id).hidden = !impactTimes.length; });
    scrub.max = frames.length - 1;
    scrub.oninput = () => seek(frames[scrub.value]);
    onTime(t => {
      scrub.value = nearest(frames, t);
      scrub.setAttribute('aria-valuetext', instant(t));
      byId('clock').textContent = 't = ' + (t / 10 ** clockScale.power).toFixed(clockDigits) + '\u00a0' + clockScale.unit;
    });
  }
  const wanted = (timeEnd - timeStart) / 10 || 1;
  setSpeed(speeds.reduce((a, b) => abs(Math.log(b / wanted)) < abs(Math.log(a / wanted)) ? b : a));
}
