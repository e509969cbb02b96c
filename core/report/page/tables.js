// Tables: facts, joints, impacts, twin, drivers, energy, advice, model, provenance, and runs side by side.
const at = (part, name, field) => '/' + part + '/' + escaped(name) + '/' + field;
// Of a driver that gives a speed only its channel says whether it turns or slides.
const effort = (run, name) => run.named.has('driver.' + name + '.force') || ['position', 'force'].includes(run.get(at('drivers', name, 'kind'))) ? 'N' : 'N*m';
const right = text => ({number: text});
const has = path => runs.some(r => Object.keys(Object(r.get(path) ?? {})).length || typeof r.get(path) === 'number');
const put = (id, ...content) => { if (byId(id)) byId(id).append(make('div', {class: 'wide'}, ...content)); };

function startTop() {
  for (const run of runs) {
    const {stop_reason, trust} = run.summary, {verdict, reasons} = trust && trust.verdict ? trust : {verdict: 'none', reasons: []};
    byId('verdicts').append(make('div', {}, make('b', {}, titled(run)),
      span(shown(run, '/status'), stop_reason ? ' (' + stop_reason + ')' : '', ' at ', shown(run, '/time/reached', instant)),
      make('span', {class: 'chip ' + verdict}, {good: '✓ trust: good', doubtful: '! trust: doubtful', bad: '✕ trust: bad', none: '! no verdict'}[verdict]),
      make('b', {}, run.note || ''),
      reasons.length ? make('ul', {}, ...reasons.map(r => make('li', {}, r.level + ': ' + r.message))) : null));
  }
  byId('contents').append(...[...document.querySelectorAll('main section')].map(s => make('a', {href: '#' + s.id}, s.querySelector('h2').textContent)));
}

// Lines of a table with a column per run, of a path of the summary or of what a function finds, for those that some run has.
function lines(list) {
  return list.filter(([, path]) => path.call ? runs.some(path) : has(path)).map(([label, path, write]) => row(label, ...runs.map(r => path.call ? path(r) : shown(r, path, write))));
}
const heads = () => ['', ...runs.map(titled)];

function startFacts() {
  const changed = r => [...entries(r.get('/settings/set')).map(([k, v]) => k + ' = ' + v), ...(r.get('/settings/ideal') || []).map(n => n + ' ideal')].join(', ');
  const steps = r => r.get('/settings/step/adaptive') ? span(shown(r, '/time/smallest_step', 's'), ' to ', shown(r, '/time/largest_step', 's')) : shown(r, '/settings/step/size', 's');
  const second = r => r.summary.verification ? r.summary.verification.method + ': ' + {agree: 'agrees', err: 'one of both errs', part: 'agrees up to a time', disagree: 'disagrees'}[r.summary.verification.agreement] : '';
  const warnings = r => (r.summary.warnings || []).length ? span(...r.summary.warnings.flatMap(w => [w, make('br')])) : '';
  put('facts', table(heads(), lines([['Model', '/model/space'], ['Bodies', '/model/bodies'], ['Joints', '/model/joints'], ['Joints with play', '/model/clearance_joints'], ['Drivers', '/model/drivers'],
    ['Degrees of freedom', '/model/dof'], ['Left by the drivers', '/model/dof_driven'], ['Changed', changed], ['Integrator', '/settings/integrator/type'], ['Accuracy', '/settings/step/accuracy', 'm'], ['Tolerance', '/settings/step/tolerance', '1'],
    ['Steps of', steps], ['Second run', second], ['Row every', '/settings/interval', 's'],
    ['Status', '/status'], ['Time reached', '/time/reached', instant], ['Counted from', '/statistics/from', 's'], ['Rows', '/counts/rows'], ['Steps', '/counts/steps'], ['Contacts', '/counts/contacts'],
    ['Energy residual', '/residuals/energy_max', 'J'], ['Position residual', '/residuals/position_max', 'm'], ['Warnings', warnings]])));
  if (runs.length > 2) byId('facts').style.flexBasis = '100%';
  if (!several) document.querySelector('#facts table').className = 'one';
}

// Where a field of a part is largest in a run; null where none has it.
const largest = (part, field) => run => {
  const all = entries(run.summary[part]).filter(([, x]) => typeof x[field] === 'number');
  return all.length ? at(part, all.reduce((a, b) => abs(b[1][field]) > abs(a[1][field]) ? b : a)[0], field) : null;
};

function startSide() {
  // Path and unit of each are texts, or functions of a run.
  const compare = ([label, path, unit]) => {
    const of = (x, r) => x?.call ? x(r) : x;
    const paths = runs.map(r => of(path, r)), units = runs.map(r => of(unit, r));
    const values = runs.map((r, k) => paths[k] && r.get(paths[k])), known = v => typeof v === 'number';
    if (!values.some(known)) return [];
    const noise = k => runs[k].get('/noise' + paths[k]) || 0, percent = (v, k) => k && values[0] && units[k] === units[0] ? abs(v - values[0]) < noise(k) + noise(0) ? 'within the scatter' : (v >= values[0] ? '+' : '−') + plain(abs(100 * (v / values[0] - 1)), 3) + '\u00a0%' : '';
    return [row(label, ...runs.map((r, k) => right(known(values[k]) ? span(scattered(r, paths[k], units[k]), k ? make('br') : '', make('span', {class: 'soft'}, percent(values[k], k))) : '–')))];
  };
  const all = part => [...new Set(runs.flatMap(r => Object.keys(r.summary[part] || {})))];
  const errors = [['largest error', 'max_position', 'm'], ['rms error', 'rms_position', 'm'], ['largest angle error', 'max_angle', 'rad'], ['rms angle error', 'rms_angle', 'rad']];
  const list = [...all('paths').flatMap(n => errors.map(([words, field, unit]) => [n + ', ' + words, at('paths', n, field), unit])),
    ['largest joint force', largest('joints', 'max_force'), 'N'], ['largest rms joint force', largest('joints', 'rms_force'), 'N'], ['largest penetration', largest('joints', 'max_delta'), 'm'],
    ['contacts', '/counts/contacts'], ['energy lost in joints', '/energy/dissipated', 'J'], ['work of the drivers', '/energy/work', 'J'],
    ...all('drivers').flatMap(n => [['largest', 'max_abs'], ['rms', 'rms']].map(([which, field]) => [n + ', ' + which + ' effort', at('drivers', n, field), r => effort(r, n)]))];
  put('side', table(['', ...runs.map(r => right(r.title))], list.flatMap(compare)));
}

// A row per element of a part, a group per run. Columns: heading, field or a function of the element, unit, whether it scatters.
function figures(part, heading, columns, needed) {
  const bodies = runs.map(run => {
    const rows = entries(run.get(part)).filter(([, x]) => x && (!needed || x[needed])).map(([name, x]) => row(name, ...columns.map(([, field, unit, scatters]) => {
      if (typeof field !== 'string') return field(x, name, run);
      const path = at(part.slice(1), name, ''), known = unit || effort(run, name);
      // Where impacts make a joint's largest force uncertain its sums are, too.
      const rough = !scatters && run.get('/noise' + path + 'max_force') >= 0.005 * x.max_force;
      return right((scatters ? scattered : shown)(run, path + field, rough ? v => '~' + (known.call ? known(+v.toPrecision(2)) : quantity(v, known, 2)) : known));
    })));
    return several && rows.length ? [make('tr', {}, make('th', {colspan: columns.length + 1, class: 'group'}, run.title)), ...rows] : rows;
  });
  return bodies.flat().length ? table([heading, ...columns.map(([h, f]) => typeof f === 'string' ? right(h) : h)], ...bodies) : '';
}

function startFigures() {
  const bar = ({play}) => make('span', {class: 'bar', role: 'img', 'aria-label': 'shares of flight, impact and lasting contact'}, ...['flight', 'impact', 'lasting'].map(w => {
    const part = make('i', {class: w});
    part.style.width = 100 * (play[w] || 0) + '%';
    return part;
  }));
  put('clearance', figures('/joints', 'Joint', [['shares', bar], ['flight', 'play/flight', percent], ['impact', 'play/impact', percent], ['lasting', 'play/lasting', percent], ['impacts', 'play/impacts', String],
    ['fastest', 'play/max_approach_speed', 'm/s'], ['largest force', 'max_fn', 'N', true], ['mean force', 'play/mean_fn', 'N'], ['load at', 'play/load_angle', v => plain(v * 180 / PI, 3) + '\u00a0deg'], ['penetration', 'max_delta', 'm'],
    ['slid', 'play/sliding', 'm'], ['load × slip', 'play/work', 'J'], ['largest p·v', 'play/pv_max', 'Pa*m/s']], 'play'));
  const pose = [['largest error', 'max_position', 'm', true], ['rms', 'rms_position', 'm'], ['largest angle', 'max_angle', 'rad', true], ['rms', 'rms_angle', 'rad']];
  put('twin', figures('/twin/drivers', 'Driver', [['largest difference', 'max'], ['rms', 'rms'], ['ripple', 'ripple', percent]]), figures('/twin/bodies', 'Body', pose));
  put('drivers', figures('/drivers', 'Driver', [['gives', x => x.kind], ['largest effort', 'max_abs', null, true], ['rms', 'rms'], ['work', 'work', 'J']]), has('/paths') ? figures('/paths', 'Path', pose) : '');
  if (runs.some(r => r.get('/settings/discard') > 0)) put('energy', make('p', {class: 'lead'}, 'Sums are of the whole run, those by driver, force and joint of the time that counts.'));
  put('energy', table(heads(), lines([['Kinetic, at the end', '/energy/kinetic', 'J'], ['Potential, at the end', '/energy/potential', 'J'], ['Work of drivers and forces', '/energy/work', 'J'], ['Lost', '/energy/dissipated', 'J'], ['Residual', '/energy/residual', 'J']])),
    make('div', {class: 'columns'}, has('/drivers') ? figures('/drivers', 'Work of driver', [['', 'work', 'J']]) : '', has('/forces') ? figures('/forces', 'Force', [['largest', 'max_force', 'N', true], ['largest moment', 'max_torque', 'N*m', true], ['work', 'work', 'J']]) : '', has('/joints') ? figures('/joints', 'Lost in joint', [['', 'dissipated', 'J']], 'dissipated') : ''), make('div', {class: 'graph'}));
  const step = r => r.get('/advice/step');
  put('advice', table(heads(), lines([['Impacts with too few steps', '/advice/under_resolved'], ['Fewest steps in an impact', '/advice/min_steps_per_contact', v => plain(v, 3)],
    ['Step that would do', r => step(r) ? shown(r, '/advice/step', 's') : 'the one taken'], ['Command', r => step(r) && make('code', {}, r.rerun + ' --step "' + step(r).toPrecision(2) + ' s"')]])));
}

function startImpacts() {
  const wanted = [['joint', 'Joint', ''], ['max_fn', 'largest force', 'N'], ['approach_speed', 'approach', 'm/s'], ['duration', 'lasted', 's'], ['impulse', 'impulse', 'N*s'], ['energy_lost', 'energy lost', 'J'], ['steps', 'steps', '1']];
  for (const run of runs.filter(r => r.events.rows.length)) {
    const {columns: names, rows, total} = run.events;
    const columns = wanted.map(([f, label, unit]) => [names.indexOf(f), label, unit]).filter(c => c[0] >= 0), times = rows.map(r => r[0]);
    const list = rows.map(r => make('tr', {class: 'pick', tabindex: 0, onclick: () => seek(r[0]), onkeydown: e => { if (e.key === 'Enter') seek(r[0]); }}, cell(instant(r[0]), 'th'),
      ...columns.map(([k, , unit]) => cell(unit ? right(quantity(r[k], unit)) : String(r[k])))));
    put('impacts', make('p', {class: 'lead'}, titled(run) + ' ' + (total > rows.length ? 'the ' + rows.length + ' largest of ' : '') + total + ' contacts that ended, in order of time'),
      make('div', {class: 'scroll', tabindex: 0}, table(['Ended', ...columns.map(c => c[2] ? right(c[1]) : c[1])], list)));
    let near = list[0];
    onTime(t => {
      near.classList.remove('near');
      near = list[lastUpTo(times, t)];
      near.classList.add('near');
    });
  }
}

function startModel() {
  for (const run of runs.filter(r => r.model)) {
    put('model', make('h3', {}, titled(run)), make('p', {class: 'command'}, 'Run it again: ', make('code', {}, run.rerun), make('button', {class: 'controls', onclick: e => copy(run.rerun, e.target)}, 'Copy')), make('pre', {tabindex: 0}, run.model));
  }
  const record = (title, parts) => [make('h3', {}, title), make('pre', {tabindex: 0}, JSON.stringify(parts, (key, part) => key === 'text' ? undefined : part, 1))];
  put('provenance', ...record('This page', data.provenance), ...runs.filter(r => r.get('/provenance')).flatMap(r => record(r.title, r.get('/provenance'))));
}
