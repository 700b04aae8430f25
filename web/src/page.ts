import type { WeftClient } from '../../proto/js/index.js';
import type { Frame, State, Viewer } from '../../proto/js/messages.js';
import { BoxView } from './panel/box_view.js';
import { Crowd } from './crowd.js';
import { OrbitCamera } from './view/camera.js';
import { Director, view_of_address } from './view/director.js';
import { connect_client, explain_refusals } from './wire/connection.js';
import { fan_of_view, Fans } from './view/fans.js';
import { Hands } from './view/hands.js';
import { HandLatency } from './hold/hand_latency.js';
import { Holding } from './hold/holding.js';
import { Input } from './hold/input.js';
import type { Window } from './view/framing.js';
import { KEY_HAND, KeyHand } from './hold/key_hand.js';
import { listen_to_keys } from './hold/keys.js';
import { Laboratory } from './view/laboratory.js';
import { asks_for_simple_light } from './view/light.js';
import { loss_text, notice_text } from './panel/events.js';
import { element } from './panel/element.js';
import { Panels, type Phase } from './panel/panels.js';
import { covered } from './panel/free_part.js';
import { Hint } from './panel/hint.js';
import { LaboratoryPanel } from './panel/laboratory_panel.js';
import { NameDialog, own_name } from './panel/own_name.js';
import { frame_focus } from './panel/focus_frame.js';
import { title_of } from './panel/scene_title.js';
import { PictureClock } from './view/picture_clock.js';
import { Pins } from './view/pins.js';
import { Reticle } from './view/reticle.js';
import { RoomPanel } from './panel/rooms.js';
import { Stage } from './view/stage.js';
import { ThemeSwitch } from './panel/theme.js';
import type { Theme } from './panel/theme.js';
import { ToldCamera } from './wire/told_camera.js';
import { Toolbar } from './panel/toolbar.js';
import { WindowTools } from './panel/window_tools.js';
import { WorldView } from './view/world_view.js';

/**
 * Connects input, camera, picture and panels to the client; each of them knows only its own task.
 */
export class Page {
  readonly canvas = element<HTMLCanvasElement>('view');
  private wall = element<HTMLDialogElement>('wall');
  readonly orbit = new OrbitCamera();
  private director = new Director(this.orbit, () => this.window());
  readonly hands = new Hands(element('labels'));
  readonly pins = new Pins();
  readonly fans = new Fans();
  readonly client: WeftClient;
  readonly box_view: BoxView;
  readonly laboratory = new Laboratory();
  private laboratory_panel: LaboratoryPanel;
  readonly input: Input;
  readonly holding: Holding;
  readonly key_hand: KeyHand;
  world: WorldView | null = null;
  state: State | null = null;
  phase: Phase = 'connecting';
  pictures = 0;
  private panels = new Panels();
  readonly stage = new Stage(this.canvas, asks_for_simple_light(window.location.search), {
    lost: (away) => {
      this.panels.picture_lost(away);
      this.dirty = true;
    },
    changed: () => (this.dirty = true),
  });
  private window_tools = new WindowTools(() => (this.dirty = true));
  private hint = new Hint();
  private toolbar: Toolbar;
  readonly reticle = new Reticle();
  readonly crowd: Crowd;
  private viewers: Viewer[] = [];
  private told_camera: ToldCamera;
  private clock = new PictureClock();
  private dirty = true;
  private unframed = false; // no frame of this scene has been shown
  private latency = new HandLatency();

  constructor() {
    this.stage.scene.add(this.hands.group, this.pins.group, this.fans.group, this.reticle.group);
    this.client = connect_client(own_name());
    this.told_camera = new ToldCamera(this.client);
    const tell = (text: string) => this.panels.tell(text);
    const view = { frame: () => this.frame(), fan: () => fan_of_view(this.orbit) };
    this.toolbar = new Toolbar(this.client, tell, view);
    this.box_view = new BoxView(this.client, () => (this.dirty = true), tell);
    this.stage.scene.add(this.box_view.boxes.lines);
    new NameDialog(this.client, tell);
    const rooms = new RoomPanel(this.client, tell);
    this.laboratory_panel = new LaboratoryPanel(this.client, (test) => {
      void this.laboratory.show(test).then(() => (this.dirty = true));
    });
    this.stage.scene.add(this.laboratory.lines);
    const reach = {
      client: this.client,
      orbit: this.orbit,
      fans: this.fans,
      pins: this.pins,
      world: () => this.world,
      viewer: (id: number) => this.viewer(id),
      hand_mode: () => this.toolbar.hand_mode,
      moves_objects: () => this.toolbar.moves_objects,
      is_finger: (hand: number) => this.input.is_finger(hand),
      size: () => this.size(),
      show_fans: () => this.show_fans(),
      tell,
      lost: (hand: number, reason: string) => this.lost(hand, reason),
      announce: (text: string) => (element('announcer').textContent = text),
      changed: () => (this.dirty = true),
    };
    const grabs = () => this.holding.grabs;
    this.crowd = new Crowd(this.hands.labels, { ...reach, director: this.director, grabs });
    this.stage.scene.add(this.crowd.cursors.group);
    this.holding = new Holding(reach);
    this.key_hand = new KeyHand(reach, this.holding.pointed, this.holding);
    this.input = new Input(this.canvas, {
      take: (hand, point) => this.holding.take(hand, point),
      take_object: (hand, point) => this.holding.take_object(hand, point),
      follow: (hand, point) => this.holding.follow(hand, point),
      push: (factor) => this.holding.push(factor),
      let_go: (hand, meant) => this.holding.let_go(hand, meant),
      pressable: (hand, point) => this.holding.pressable(hand, point),
      press: (point) => this.holding.press(point),
      ...this.camera_actions(),
      changed: () => (this.dirty = true),
    });
    listen_to_keys({
      toggle_pin: () => this.toggle_pin(),
      toggle_cursor: () => this.key_hand.toggle(),
      arrow: (x, y, in_depth) => this.key_hand.arrow(x, y, in_depth),
      enter: () => this.key_hand.enter(),
      escape: () => this.key_hand.escape(),
      toggle_pause: () => this.toolbar.toggle_pause(),
      step: () => this.toolbar.one_step(),
      reset: () => this.toolbar.reset(),
      toggle_fan: () => this.toolbar.toggle_fan(),
      toggle_boxes: () => this.box_view.toggle(),
      toggle_sling: () => this.toolbar.toggle_sling(),
      toggle_objects: () => this.toolbar.toggle_objects(),
      widen: (factor) => this.widen(factor),
      squeeze: () => this.holding.taking.squeeze(this.input.point),
      frame: () => this.frame(),
      scenes: () => this.toolbar.show_scenes(),
      rooms: () => void rooms.open(),
      copy: () => void rooms.copy(),
      help: () => this.toolbar.show_help(),
      figures: () => this.panels.toggle_figures(),
      hide_panels: () => this.window_tools.toggle_panels(),
      change_speed: (steps) => this.toolbar.change_speed(steps),
      ...this.camera_actions(),
    });
    new ThemeSwitch((theme) => this.recolor(theme));
    frame_focus(this.canvas);
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
      this.holding.grabs = [];
      this.holding.taking.grippers.renew();
      this.box_view.renew();
      this.laboratory_panel.renew();
      if (!same) {
        this.key_hand.forget();
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
      this.hint.offer(this.holding.allowed);
      this.show_pins();
    });
    client.on('pins', ({ pins }) => {
      this.pins.list = pins;
      this.show_pins();
    });
    client.on('grabs', ({ grabs }) => {
      this.holding.grabs = grabs;
      this.dirty = true;
    });
    client.on('notice', (notice) => {
      const text = notice_text(notice, {
        own: client.viewer,
        scene: title_of(this.world?.announcement.scene ?? ''),
        name: (id) => this.viewer(id)?.name,
      });
      if (text) panels.tell(text);
    });
    client.on('refused', ({ code, message }) => code !== 'unknown_drag' && panels.tell(message));
    client.on('fault', ({ message }) => panels.tell(message));
    document.addEventListener('visibilitychange', () => this.world?.playback.forget());
    window.addEventListener('blur', () => this.key_hand.cancel());
  }

  private change_phase(phase: Phase): void {
    this.phase = phase;
    this.panels.connection(phase);
    this.toolbar.enable(phase === 'open');
    this.told_camera.renew();
    if (phase === 'open') return;
    this.input.cancel();
    this.key_hand.cancel();
    this.holding.grabs = [];
    this.world?.playback.forget();
  }

  private receive(frame: Frame): void {
    const now = performance.now() / 1000;
    this.world?.push(frame, now);
    this.panels.tick(frame.tick, frame.serverTime);
    this.latency.received(frame.serverTime, this.client.latency, now);
  }

  private show_fans(): void {
    if (this.state && !this.holding.holds_fan && this.fans.receive(this.state.fans)) this.dirty = true;
  }

  private show_pins(): void {
    this.pins.set(this.pins.list, (viewer) => this.viewer(viewer)?.color ?? null);
    if (this.world) this.pins.follow(this.world.playback.positions);
    this.dirty = true;
  }

  private recolor(theme: Theme): void {
    this.stage.theme = theme;
    this.panels.recolor();
  }

  private viewer(id: number): Viewer | undefined {
    return this.viewers.find((viewer) => viewer.id === id);
  }

  /** At what a pointer holds, at the keyboard's cursor, or under the mouse. */
  private toggle_pin(): void {
    if (this.input.state !== 'holding' && this.key_hand.toggle_pin()) return;
    this.holding.toggle_pin(this.input.point);
  }

  private widen(factor: number): void {
    this.holding.widen(factor);
    this.panels.tell(`Your hand takes ${(this.holding.radius * 200).toFixed(1)} cm of the cloth`);
    this.dirty = true;
  }

  private lost(hand: number, reason: string): void {
    const text = loss_text(reason);
    if (text && this.phase === 'open') this.panels.tell(text);
    if (hand === KEY_HAND) this.key_hand.cancel();
    else this.input.drop(hand);
  }

  /** Moves the camera by the viewer's hand, who keeps it from then on. */
  private camera_actions() {
    const { crowd, orbit } = this;
    return {
      orbit: (azimuth: number, elevation: number) => (crowd.leave(), orbit.orbit(azimuth, elevation)),
      zoom: (factor: number) => (crowd.leave(), orbit.zoom(factor)),
      pan: (dx: number, dy: number) => (crowd.leave(), orbit.pan(dx, dy)),
    };
  }

  private frame(at_once = false): void {
    if (!this.world) return;
    if (!at_once) this.crowd.leave();
    const asked = view_of_address(window.location.search);
    const { view = null } = this.world.announcement;
    this.director.begin(this.world.subject(), asked ?? view, at_once);
  }

  /** The part of the picture that no panel covers. */
  private window(): Window {
    const { width, height } = this.size();
    return this.orbit.window(covered(width, height));
  }

  // ---- the picture --------------------------------------------------------------------------

  /** Whether the picture on the screen is up to date and as fine as it gets. */
  get fine(): boolean {
    return this.stage.quality.still && this.stage.fine && !this.dirty;
  }

  get lit(): boolean {
    return this.stage.lit;
  }

  /** Draws again, as something has changed that is not part of the world. */
  redraw(): void {
    this.dirty = true;
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
    if (this.orbit.update(this.clock.step(now))) {
      this.told_camera.renew();
      this.dirty = true;
    }
    this.watch_latency(now);
    if (this.holding.holds_cloth) this.hint.done();
    const moved = this.world?.show(now, this.holding.holds_cloth) ?? false;
    if (moved && this.world) {
      this.dirty = true;
      this.pins.follow(this.world.playback.positions);
      // A viewer that joins late finds the cloth moved from its start.
      if (this.unframed) this.frame(true);
      // A hand's target is where it is in the picture, so the picture stays while one holds.
      else if (!this.holding.holds_cloth) this.director.follow(this.world.playback.positions, now);
      this.unframed = false;
    }
    if (this.world) this.told_camera.tell(this.orbit.description(), now);
    this.box_view.follow(this.world?.playback.tick ?? -1);
    this.laboratory_panel.follow(now);
    if (this.wall.open) return; // it covers the picture, and paints its own
    const { still, interval } = this.clock.judge(this.dirty, moved && !this.state?.paused);
    if (this.stage.refine(still, interval)) this.resize();
    if (this.dirty) this.draw_picture();
    else if (still) this.expose();
  }

  private draw_picture(): void {
    this.dirty = false;
    this.mark_laboratory();
    this.point_at_cloth();
    this.fans.spin(this.world?.playback.tick ?? 0);
    const { width, height } = this.size();
    this.hands.update(this.holding.hands(), this.orbit.camera, width, height);
    this.crowd.draw(this.orbit.camera, { width, height });
    this.world?.look_from(this.orbit.camera, this.stage.drafts);
    this.stage.draw(this.orbit.camera);
    if (this.world && this.world.playback.tick >= 0) void this.stage.complete(this.orbit.camera);
    this.pictures += 1;
    const latency = this.latency.shown(this.world?.playback.time ?? 0, performance.now() / 1000);
    if (latency !== null) this.panels.latency(latency);
  }

  private expose(): void {
    if (!this.stage.exposes) return;
    this.world?.look_from(this.orbit.camera, false);
    this.stage.expose(this.orbit.camera);
  }

  private point_at_cloth(): void {
    const { state, point } = this.input;
    const taken = this.holding.hover(state === 'idle' ? point : null);
    this.input.follow();
    this.key_hand.follow();
    const { hovered, radius, allowed } = this.holding;
    this.crowd.company.point(hovered?.position ?? null);
    const ring = this.key_hand.holds || !allowed ? null : (this.key_hand.cursor ?? hovered);
    this.reticle.update(ring, radius, this.world, this.orbit.camera, this.size());
    const cursors = { idle: taken ? 'grab' : '', camera: 'move', holding: 'grabbing' };
    this.canvas.dataset.cursor = cursors[state];
  }

  private watch_latency(now: number): void {
    const measurable = this.holding.holds_cloth && this.state?.paused === false;
    if (this.latency.watch(measurable, now)) this.panels.latency(null);
  }

  private mark_laboratory(): void {
    if (!this.world) return;
    const { announcement, triangles, playback } = this.world;
    this.laboratory.update(announcement, triangles, playback.positions, this.pins.list);
  }
}
