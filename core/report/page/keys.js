// Keys, theme, film.
const keyHelp = [['Space', 'play or pause'], ['← →', 'one frame; with Shift ten; in the focused picture of a mechanism in space: turn'], ['Home End', 'first or last frame'],
                 ['+ −', 'faster, slower'], ['E e', 'draw play larger, smaller'], ['z', 'all of the time'], ['t', 'light or dark'], ['?', 'these keys'],
                 ['drag in a plot', 'zoom to a span of time; double click: all of it'], ['click in a plot', 'go to that instant']];

function repaint() {
  byId('theme').textContent = dark() ? 'Light' : 'Dark';
  readPalette();
  drawScene();
  for (const g of [...graphs, ...spectra]) g.dye();  // a new canvas would stay empty on paper
  drawCards(matchMedia('print').matches);  // on paper all of them
}

// The theme of the system until another is chosen; the style sheet knows that paper is light.
function startTheme() {
  const choose = theme => { page.dataset.theme = theme; repaint(); };
  matchMedia('(prefers-color-scheme: dark)').onchange = e => choose(e.matches ? 'dark' : 'light');
  matchMedia('print').onchange = repaint;
  byId('theme').onclick = () => choose(dark() ? 'light' : 'dark');
  repaint();
}

function startKeys() {
  const dialog = byId('keys'), help = () => dialog.open ? dialog.close() : dialog.showModal();
  dialog.querySelector('dl').append(...keyHelp.flatMap(([k, v]) => [make('dt', {}, k), make('dd', {}, v)]));
  byId('help').onclick = help;
  const actions = {' ': toggle, ArrowLeft: e => stepFrames(e.shiftKey ? -10 : -1), ArrowRight: e => stepFrames(e.shiftKey ? 10 : 1), Home: () => seek(timeStart), End: () => seek(timeEnd), '+': () => changeSpeed(1),
                   '=': () => changeSpeed(1), '-': () => changeSpeed(-1), e: () => changeExaggeration(0.5), E: () => changeExaggeration(2), z: unzoom, t: () => byId('theme').click(), '?': help};
  document.addEventListener('keydown', e => {
    const {tagName: tag, type, id} = e.target, slides = type === 'range' && id !== 'scrub';
    if (e.ctrlKey || e.altKey || e.metaKey || !Object.hasOwn(actions, e.key) || tag === 'SELECT' || type === 'search') return;
    if (e.key === ' ' ? /BUTTON|INPUT|SUMMARY/.test(tag) : slides && /Arrow|Home|End/.test(e.key)) return;
    actions[e.key](e);
    e.preventDefault();
  });
}

// One pass of what is seen, recorded by the browser.
function startFilm() {
  const button = byId('record'), type = 'video/webm';
  let recorder = null, last = 0;
  if (!button) return;
  button.hidden = !window.MediaRecorder || !MediaRecorder.isTypeSupported(type);
  button.onclick = () => {
    if (recorder) return recorder.stop();
    const pieces = [];
    recorder = new MediaRecorder(scene.canvas.captureStream(60), {mimeType: type, videoBitsPerSecond: 8e6});
    recorder.ondataavailable = e => pieces.push(e.data);
    recorder.onstop = () => {
      recorder = null;
      pause();
      button.textContent = 'Record';
      make('a', {href: URL.createObjectURL(new Blob(pieces, {type})), download: runs[0].title.replace(/[^\w.-]/g, '_') + '.webm'}).click();
    };
    button.textContent = 'Stop';
    show(last = clock.range[0]);
    recorder.start();
    play();
  };
  onTime(t => { if (recorder && t < last) recorder.stop(); last = t; });
}
