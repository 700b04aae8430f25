import type { Vector2 } from 'three';
import type { WeftClient } from '../../proto/js/index.js';
import type { Frame, Grab, State, Viewer } from '../../proto/js/messages.js';
import { BoxView } from './box_view.js';
import { OrbitCamera } from './camera.js';
import { connect_client, explain_refusals, tell_refusal } from './connection.js';
import { FanHold } from './fan_hold.js';
import { fan_of_view, Fans } from './fans.js';
import type { FanHit } from './fans.js';
import { Hands, NO_COLOR, owner_of } from './hands.js';
import type { Hand } from './hands.js';
import { Hold } from './hold.js';
import { ObjectHold } from './object_hold.js';
import { Input } from './input.js';
import { listen_to_keys } from './keys.js';
import { element, Panels } from './panels.js';
import type { Phase } from './panels.js';
import { Pins } from './pins.js';
import { point_on_triangle } from './ray.js';
import type { ClothHit } from './ray.js';
import { Reticle } from './reticle.js';
import { Stage } from './stage.js';
import { Toolbar } from './toolbar.js';
import { WorldView } from './world_view.js';

const CAMERA_INTERVAL = 0.25; // between updates of this viewer's camera [s]
// The measurements show the first two, and the hand reports the third itself.
const SHOWN_ELSEWHERE = new Set(['frames_dropped', 'slow_motion', 'lease_expired']);
const STILL_TIME = 0.4; // without change, before the finest picture is drawn [s]
const PANEL_MARGIN = 12; // between panels and a framed box [pixels]

/**
 * Connects input, camera, picture and panels to the client; each of them knows only its own task.
 */
export class Page {
  readonly canvas = element<HTMLCanvasElement>('view');
  readonly orbit = new OrbitCamera();
  readonly hands = new Hands(element('labels'));
  readonly pins = new Pins();
  readonly fans = new Fans();
  readonly client: WeftClient;
  readonly box_view: BoxView;
  readonly input: Input;
  world: WorldView | null = null;
  state: State | null = null;
  phase: Phase = 'connecting';
  hovered: ClothHit | null = null;
  pictures = 0;
  private stage = new Stage(this.canvas);
  private panels = new Panels();
  private toolbar: Toolbar;
  private reticle = new Reticle();
  private hold: Hold | null = null;
  private fan_hold: FanHold | null = null;
  private object_hold: ObjectHold | null = null;
  private grabs: Grab[] = [];
  private viewers: Viewer[] = [];
  private last_time = performance.now() / 1000;
  private camera_told_at = 0;
  private camera_moved = true;
  private dirty = true;
  private unframed = false; // no frame of this scene has been shown
  private drawn_last_time = false;
  private changed_at = 0;
  /** Latency of a received frame that is not drawn yet. */
  private pending_latency: { came_at: number; latency: number } | null = null;

  constructor() {
    this.stage.scene.add(this.hands.group, this.pins.group, this.fans.group, this.reticle.group);
    this.client = connect_client();
    this.toolbar = new Toolbar(this.client, (text) => this.panels.tell(text), {
      frame: () => this.frame(),
      fan: () => fan_of_view(this.orbit),
    });
    const tell = (text: string) => this.panels.tell(text);
    this.box_view = new BoxView(this.client, () => (this.dirty = true), tell);
    this.stage.scene.add(this.box_view.boxes.lines);
    this.input = new Input(this.canvas, {
      take: (point) => this.take(point),
      take_object: (point) => this.take_object(point),
      follow: (point) => (this.fan_hold ?? this.object_hold ?? this.hold)?.follow(point),
      push: (factor) => (this.fan_hold ?? this.object_hold ?? this.hold)?.push(factor),
      let_go: (meant) => this.let_go(meant),
      toggle_pin: (point) => this.toggle_pin(point),
      orbit: (azimuth, elevation) => this.orbit.orbit(azimuth, elevation),
      pan: (dx, dy) => this.orbit.pan(dx, dy),
      zoom: (factor) => this.orbit.zoom(factor),
      changed: () => (this.dirty = true),
    });
    listen_to_keys({
      toggle_pin: () => this.toggle_pin(this.input.point),
      toggle_pause: () => this.toolbar.toggle_pause(),
      step: () => this.toolbar.one_step(),
      reset: () => this.toolbar.reset(),
      toggle_fan: () => this.toolbar.toggle_fan(),
      toggle_boxes: () => this.box_view.toggle(),
      toggle_sling: () => this.toolbar.toggle_sling(),
      frame: () => this.frame(),
      scenes: () => this.toolbar.show_scenes(),
      help: () => this.toolbar.show_help(),
      orbit: (azimuth, elevation) => this.orbit.orbit(azimuth, elevation),
      zoom: (factor) => this.orbit.zoom(factor),
    });
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
    requestAnimationFrame(() => this.draw());
  }

  private listen(): void {
    const { client, panels } = this;
    client.on('status', ({ phase }) => this.change_phase(phase === 'open' ? 'connecting' : phase));
    client.on('welcome', () => this.change_phase('open'));
    explain_refusals(client, (refusal) => panels.refused(refusal));
    client.on('mesh', ({ announcement, data }) => {
      const same = this.world?.announcement.scene === announcement.scene;
      this.world?.dispose();
      this.world = new WorldView(announcement, data, this.stage);
      this.pins.fit(this.world.cloth_extent);
      this.grabs = [];
      this.box_view.renew();
      if (!same) {
        this.frame(true);
        this.unframed = true;
      }
      this.dirty = true;
    });
    client.on('frame', (frame) => this.receive(frame));
    client.on('state', (state) => {
      this.state = state;
      this.toolbar.state(state);
      this.show_fans();
      panels.state(state);
    });
    client.on('roster', (roster) => {
      this.viewers = roster.viewers;
      panels.roster(roster, client.viewer);
      this.show_pins();
    });
    client.on('pins', ({ pins }) => {
      this.pins.list = pins;
      this.show_pins();
    });
    client.on('grabs', ({ grabs }) => {
      this.grabs = grabs;
      this.dirty = true;
    });
    client.on('notice', ({ level, code, message }) => {
      if (level !== 'info' && !SHOWN_ELSEWHERE.has(code)) panels.tell(message);
    });
    client.on('refused', ({ code, message }) => code !== 'unknown_drag' && panels.tell(message));
    client.on('fault', ({ message }) => panels.tell(message));
    document.addEventListener('visibilitychange', () => this.world?.playback.forget());
  }

  private change_phase(phase: Phase): void {
    this.phase = phase;
    this.panels.connection(phase);
    this.toolbar.enable(phase === 'open');
    this.camera_moved = true;
    if (phase === 'open') return;
    this.input.cancel();
    this.grabs = [];
    this.world?.playback.forget();
  }

  private receive(frame: Frame): void {
    const now = performance.now() / 1000;
    this.world?.push(frame, now);
    this.panels.tick(frame.tick, frame.serverTime);
    const { latency } = this.client;
    if (this.hold) this.pending_latency = { came_at: now, latency };
  }

  private show_fans(): void {
    if (this.state && !this.fan_hold && this.fans.receive(this.state.fans)) this.dirty = true;
  }

  private show_pins(): void {
    this.pins.set(this.pins.list, (viewer) => this.viewer(viewer)?.color ?? null);
    if (this.world) this.pins.follow(this.world.playback.positions);
    this.dirty = true;
  }

  private viewer(id: number): Viewer | undefined {
    return this.viewers.find((viewer) => viewer.id === id);
  }

  // ---- hands --------------------------------------------------------------------------------

  private pick(point: Vector2 | null): ClothHit | null {
    if (!point || !this.client.connected) return null;
    return this.world?.hit(this.orbit.ray(point)) ?? null;
  }

  private take(point: Vector2): boolean {
    const hit = this.pick(point);
    if (this.take_fan(point, hit)) return true;
    if (!hit) return false;
    const { hand_mode } = this.toolbar;
    this.hold = new Hold(this.client, hit, this.orbit, hand_mode, (reason) => this.lost(reason));
    return true;
  }

  /** Takes the handle of a fan, unless cloth is in front of it. */
  private take_fan(point: Vector2, cloth: ClothHit | null): boolean {
    const hit = this.fan_at(point, cloth);
    if (!hit) return false;
    this.fan_hold = new FanHold(hit, point, this.fans, this.orbit, (fans) => {
      const answer = this.client.set({ fans });
      this.fans.told(answer);
      answer.catch(() => this.show_fans()); // if refused, they stay where they were
      tell_refusal(answer, (text) => this.panels.tell(text));
    });
    return true;
  }

  private take_object(point: Vector2): boolean {
    if (!this.client.connected) return false;
    const hit = this.world?.hit_object(this.orbit.ray(point));
    if (!hit) return false;
    this.object_hold = new ObjectHold(hit, point, this.orbit, (move) =>
      tell_refusal(this.client.move(hit.name, move), (text) => this.panels.tell(text)),
    );
    return true;
  }

  private fan_at(point: Vector2 | null, cloth: ClothHit | null): FanHit | null {
    if (!point || !this.client.connected) return null;
    const { width, height } = this.size();
    const hit = this.fans.at(point, this.orbit, width, height);
    if (!hit || !cloth) return hit;
    return this.orbit.depth(hit.position) < this.orbit.depth(cloth.position) ? hit : null;
  }

  private let_go(meant: boolean): void {
    this.fan_hold?.end();
    this.fan_hold = null;
    this.object_hold?.end();
    this.object_hold = null;
    this.hold?.end(meant);
    this.hold = null;
    this.pending_latency = null;
  }

  private lost(reason: string): void {
    if (this.phase === 'open') this.panels.tell(`The cloth slipped out of your hand: ${reason}`);
    this.input.cancel();
  }

  /** Pins the held or indicated point, or releases it if it is pinned. */
  private toggle_pin(point: Vector2 | null): void {
    if (!this.client.connected || !this.world) return;
    const held = this.hold;
    const hit = held ? null : this.pick(point);
    // A fan cannot be pinned, and hides what is behind it.
    if (this.fan_hold || (!held && this.fan_at(point, hit))) return;
    const at = held ?? hit;
    const particle = at && this.nearest_corner(at);
    const { width, height } = this.size();
    const meant = held ? null : point;
    const pins = this.pins.at(meant, particle, this.orbit.camera, width, height);
    const answers = pins.length
      ? pins.map(({ id }) => this.client.release({ pin: id }))
      : at
        ? [this.client.pin({ triangle: at.triangle, barycentric: at.barycentric })]
        : [];
    for (const answer of answers) tell_refusal(answer, (text) => this.panels.tell(text));
  }

  /** The particle that the server pins for a point of a triangle. */
  private nearest_corner({ triangle, barycentric }: Pick<ClothHit, 'triangle' | 'barycentric'>) {
    const corner = barycentric.indexOf(Math.max(...barycentric));
    return this.world?.triangles[triangle * 3 + corner] ?? null;
  }

  private frame(at_once = false): void {
    if (!this.world) return;
    const toolbar = element('toolbar').getBoundingClientRect();
    const corners = [...document.querySelectorAll('.corner')];
    const { height } = this.size();
    const lowest = Math.max(...corners.map((corner) => corner.getBoundingClientRect().bottom));
    const above = Math.min(0.25, (lowest + PANEL_MARGIN) / height);
    const below = Math.min(0.4, (height - toolbar.top) / height);
    this.orbit.frame(this.world.bounds(), { above, below }, at_once);
  }

  // ---- the picture --------------------------------------------------------------------------

  /** Whether the picture on the screen is up to date and as fine as it gets. */
  get fine(): boolean {
    return this.stage.at_rest && !this.dirty;
  }

  private size(): { width: number; height: number } {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  private resize(): void {
    const { width, height } = this.size();
    this.stage.resize(width, height);
    this.orbit.resize(width, height);
    this.dirty = true;
  }

  private draw(): void {
    requestAnimationFrame(() => this.draw());
    const now = performance.now() / 1000;
    const elapsed = Math.min(0.1, now - this.last_time);
    this.last_time = now;
    if (this.orbit.update(elapsed)) this.camera_moved = this.dirty = true;
    if (this.world?.show(now, this.hold !== null)) {
      this.dirty = true;
      this.pins.follow(this.world.playback.positions);
      // A viewer that joins late finds the cloth moved from its start.
      if (this.unframed) this.frame(true);
      this.unframed = false;
    }
    this.tell_camera(now);
    this.box_view.follow(this.world?.playback.tick ?? -1);
    const again = this.drawn_last_time;
    this.drawn_last_time = this.dirty;
    if (this.dirty) this.changed_at = now;
    const resized = this.stage.set_still(now - this.changed_at > STILL_TIME);
    const coarser = this.dirty && again && this.stage.judge(elapsed);
    if (resized || coarser) this.resize();
    if (!this.dirty) return;
    this.dirty = false;
    this.point_at_cloth();
    this.fans.spin(this.world?.playback.tick ?? 0);
    const { width, height } = this.size();
    this.hands.update(this.hands_to_show(), this.orbit.camera, width, height);
    this.stage.renderer.render(this.stage.scene, this.orbit.camera);
    this.pictures += 1;
    this.measure_latency();
  }

  private point_at_cloth(): void {
    const idle = this.input.state === 'idle';
    this.hovered = idle ? this.pick(this.input.point) : null;
    const fan = idle ? this.fan_at(this.input.point, this.hovered) : null;
    if (fan) this.hovered = null;
    if (this.input.point) (this.fan_hold ?? this.object_hold ?? this.hold)?.follow(this.input.point);
    this.reticle.update(this.hovered, this.world, this.orbit.camera, this.size().height);
    const holding = this.input.state === 'holding';
    this.canvas.dataset.cursor = holding
      ? 'grabbing'
      : this.hovered || fan
        ? 'grab'
        : this.input.state === 'camera'
          ? 'move'
          : '';
  }

  /** The own hand at the pointer, others as in the shown frame. */
  private hands_to_show(): Hand[] {
    const { world, hold, client } = this;
    if (!world) return [];
    const place = ({ triangle, barycentric }: Pick<ClothHit, 'triangle' | 'barycentric'>) =>
      point_on_triangle(triangle, barycentric, world.playback.positions, world.triangles);
    const hands = this.grabs
      .filter(({ id, viewer }) => viewer !== client.viewer && id !== hold?.grab)
      .map((grab): Hand => {
        const sample = world.playback.grabs.find(({ id }) => id === grab.id);
        const target = (sample?.target ?? grab.target) as Hand['target'];
        return { ...owner_of(grab, this.viewer(grab.viewer)), held: place(grab), target };
      });
    if (hold) {
      const own = this.viewer(client.viewer);
      hands.push({
        id: hold.grab ?? 0,
        name: own?.name ?? '',
        color: own?.color ?? NO_COLOR,
        held: place(hold),
        target: hold.target,
        own: true,
      });
    }
    return hands;
  }

  private measure_latency(): void {
    if (!this.pending_latency) return;
    const { came_at, latency } = this.pending_latency;
    this.panels.latency(latency + performance.now() / 1000 - came_at);
    this.pending_latency = null;
  }

  private tell_camera(now: number): void {
    if (!this.camera_moved || !this.client.connected || !this.world) return;
    if (now - this.camera_told_at < CAMERA_INTERVAL) return;
    this.camera_moved = false;
    this.camera_told_at = now;
    const { position, target, fov } = this.orbit.description();
    this.client.post('camera', { position, target, fov });
  }
}
