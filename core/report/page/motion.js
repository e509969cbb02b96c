// Where bodies and joints of a run are at an instant, from its frames.
class Motion {
  constructor(run) {
    const a = run.animation, three = p => p && [p[0], p[1], p[2] || 0], index = new Map(a.bodies.map((b, k) => [b.name, k]));
    const body = name => index.has(name) ? index.get(name) : -1;  // -1: ground
    this.run = run;
    this.spatial = a.space === 'spatial';
    this.size = this.spatial ? 7 : 3;
    this.times = frameTimes[run.index];
    this.bodies = a.bodies.map(b => ({...b, points: b.points.map(three), poses: decode(b.poses)}));
    this.joints = a.joints.map(j => ({...j, first: body(j.first), second: body(j.second), at_first: three(j.at_first), at_second: three(j.at_second),
                                      axis: three(j.axis), forces: decode(j.forces)}));
    this.marks = a.marks.map(m => ({...m, body: body(m.body), at: three(m.at)}));
    this.poses = [];
    this.offsets = new Map(this.joints.filter(j => j.clearance).map(j => [j, this.offsetsOf(j)]));
    this.box();
    const {columns, rows} = run.events, at = name => columns.indexOf(name), force = r => r[at('max_fn')] || 0;
    const largest = max(...rows.map(force), 1e-300);
    this.flashes = rows.map(r => [r[at('joint')], r[0] - (r[at('duration')] || 0), Math.sqrt(force(r) / largest)]);
  }

  numbers(body, frame) {
    const {poses, offset} = this.bodies[body], at = poses.length < this.size * this.times.length ? 0 : frame * this.size;
    return offset.map((o, k) => o + poses[at + k]);
  }

  // Position, and rotation matrix by rows.
  pose(numbers) {
    if (!this.spatial) {
      const c = cos(numbers[2]), s = sin(numbers[2]);
      return {at: [numbers[0], numbers[1], 0], r: [c, -s, 0, s, c, 0, 0, 0, 1]};
    }
    const n = hypot(...numbers.slice(3)) || 1, [w, x, y, z] = numbers.slice(3).map(v => v / n);
    return {at: numbers.slice(0, 3), r: [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
                                         2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]};
  }

  // Between two frames: straight in positions and angles; quaternions on the same side.
  moveTo(t) {
    const k = lastUpTo(this.times, t), next = this.times[k + 1];
    this.frame = k;
    this.part = next === undefined ? 0 : max(0, min(1, (t - this.times[k]) / (next - this.times[k])));
    this.poses = this.bodies.map((_, body) => {
      const a = this.numbers(body, k);
      if (!this.part) return this.pose(a);
      const b = this.numbers(body, k + 1), turned = this.spatial && a.slice(3).reduce((sum, v, i) => sum + v * b[3 + i], 0) < 0;
      return this.pose(a.map((v, i) => v + this.part * ((turned && i > 2 ? -b[i] : b[i]) - v)));
    });
  }

  direction(body, d, poses = this.poses) {
    if (body < 0) return d;
    const {r} = poses[body];
    return [0, 3, 6].map(i => r[i] * d[0] + r[i + 1] * d[1] + r[i + 2] * d[2]);
  }
  world(body, p, poses = this.poses) {
    return body < 0 ? p : this.direction(body, p, poses).map((x, i) => x + poses[body].at[i]);
  }
  worldIn(frame, body, p) { return body < 0 ? p : this.world(body, p, {[body]: this.pose(this.numbers(body, frame))}); }

  // Journal from the centre of its bearing in every frame: between frames these change less than poses do.
  offsetsOf({first, second, at_first, at_second}) {
    return Float64Array.from(Array.from(this.times, (_, k) => {
      const p = this.worldIn(k, first, at_first);
      return this.worldIn(k, second, at_second).map((x, i) => x - p[i]);
    }).flat());
  }
  between(numbers, size) {
    const at = i => numbers[size * this.frame + i];
    return [0, 1, 2].map(i => i < size ? at(i) + (this.part ? this.part * (at(size + i) - at(i)) : 0) : 0);
  }
  offset(joint) { return this.between(this.offsets.get(joint), 3); }
  force(joint) { return this.between(joint.forces, this.spatial ? 3 : 2); }

  // How bright the latest impact of a joint still is, 0 to 1.
  flash(joint) {
    return max(0, ...this.flashes.filter(f => f[0] === joint.name).map(([, t, size]) => {
      const age = (clock.time - t) / flashSeconds / clock.speed;
      return age >= 0 && (1 - age) * (0.3 + 0.7 * size);
    }));
  }

  // Everything that is ever drawn lies between low and high.
  box() {
    const all = [], some = max(1, floor(this.times.length / 60));
    for (let k = 0; k < this.times.length; k += some) this.bodies.forEach((b, body) => all.push(...b.points.map(p => this.worldIn(k, body, p))));
    for (const j of this.joints) if (j.first < 0) all.push(j.at_first); else if (j.second < 0) all.push(j.at_second);
    const ends = [0, 1, 2].map(i => all.map(p => p[i]).filter(isFinite));
    this.low = ends.map(xs => xs.reduce((a, b) => min(a, b), Infinity));
    this.high = ends.map(xs => xs.reduce((a, b) => max(a, b), -Infinity));
  }

  // Points of the path of a body or a mark, one per frame.
  path(name) {
    const mark = this.marks.find(m => m.name === name) || {body: this.bodies.findIndex(b => b.name === name), at: [0, 0, 0]};
    return mark.body < 0 ? null : Array.from(this.times, (_, k) => this.worldIn(k, mark.body, mark.at));
  }
}
