// The 3D view: camera, light, looks of the instances, picking.

import {
  Box3, Color, DirectionalLight, GridHelper, HemisphereLight, MOUSE, OrthographicCamera, Raycaster,
  Scene, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { ScaleBar, Triad, round_length } from './drawing.js';

// Towards the viewer; the assembly's z is up, and its front looks along its y. The top view leans by
// a hair so that the camera knows which way is up.
const VIEWS = {
  iso: new Vector3(1, 1, 1),
  top: new Vector3(0, 1, 1e-5),
  front: new Vector3(0, 0, 1),
  right: new Vector3(1, 0, 0),
};

const ACCENT = new Color('#0b6bf2');
const SELECTED = new Color('#7fb2ff');
const FIT_MARGIN = 1.12;
const CONTEXT_MARGIN = 2.2; // one instance and its neighbours
const TURN_MS = 260;
const CLICK_PIXELS = 4;

// How an instance is drawn, as changes to a copy of its own material.
const LOOKS = {
  own: () => {},
  hover: (material) => {
    if (material.emissive) material.emissive.copy(ACCENT).multiplyScalar(0.12);
    else material.color.copy(ACCENT);
  },
  selected: (material) => {
    if (!material.emissive) material.color.copy(ACCENT);
    // What collides stays red: its blue edges tell that it is selected.
    else if (!material.name.startsWith('colliding')) material.color.copy(SELECTED);
  },
  ghost: (material) => {
    material.transparent = true;
    material.opacity = material.emissive ? 0.1 : 0.22;
    material.depthWrite = false;
  },
};

export class Stage {
  // Throws where the browser has no WebGL.
  constructor(canvas, { root, instances }) {
    this.canvas = canvas;
    this.instances = instances;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new Scene();
    this.camera = new OrthographicCamera();
    this.half_height = 1;
    this.aspect = 1;
    this.turn = null; // where the camera is on its way from and to
    this.framed = null; // what fills the view
    this.selected = null;
    this.hovered = null;
    this.show_edges = true;
    this.xray = false;
    this.looks = new Map();
    this.on_pick = () => {};

    this.scene.add(root, this.camera);
    root.updateMatrixWorld(true);
    for (const instance of instances) {
      for (const mesh of instance.surfaces) {
        // Faces step back a little, so that the lines on their borders are whole.
        Object.assign(mesh.material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
      }
      for (const drawn of [...instance.surfaces, ...instance.lines]) drawn.own_material = drawn.material;
      instance.box = new Box3().setFromObject(instance.object);
    }
    this.add_light();
    this.add_grid();
    this.controls = this.make_controls();
    this.triad = new Triad(document.getElementById('triad'));
    this.scale = new ScaleBar(document.getElementById('scale'));
    this.listen();
    this.resize();
    this.view('iso', { turn: false });
  }

  add_light() {
    this.scene.add(new HemisphereLight('#ffffff', '#9aa3b0', 1.75));
    const key = new DirectionalLight('#ffffff', 1.55);
    key.position.set(-0.6, 1, 0.9); // over the viewer's left shoulder, whichever way he turns
    this.camera.add(key, key.target);
    key.target.position.set(0, 0, -1);
  }

  add_grid() {
    const box = this.box_of(this.instances);
    const size = box.getSize(new Vector3());
    const reach = Math.max(size.x, size.z, 0.01);
    const step = round_length(reach / 8);
    const count = 2 * Math.ceil((0.75 * reach) / step);
    this.grid = new GridHelper(count * step, count, '#9fb0c4', '#ccd5df');
    const center = box.getCenter(new Vector3());
    this.grid.position.set(
      Math.round(center.x / step) * step, box.min.y - 1e-3 * reach, Math.round(center.z / step) * step);
    this.grid.visible = false;
    this.scene.add(this.grid);
  }

  make_controls() {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.enableDamping = false;
    controls.zoomToCursor = true;
    controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN };
    controls.addEventListener('change', () => this.request_frame());
    controls.addEventListener('start', () => {
      this.turn = null;
      this.framed = null;
    });
    return controls;
  }

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    let pressed = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      pressed = event.button === 0 ? new Vector2(event.clientX, event.clientY) : null;
    });
    this.canvas.addEventListener('pointerup', (event) => {
      const here = new Vector2(event.clientX, event.clientY);
      if (pressed && pressed.distanceTo(here) <= CLICK_PIXELS) this.on_pick(this.instance_at(event));
      pressed = null;
    });
    this.canvas.addEventListener('webglcontextrestored', () => this.request_frame());
  }

  instance_at(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const point = new Vector2(
      (2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
    const ray = new Raycaster();
    ray.setFromCamera(point, this.camera);
    const owner = new Map();
    for (const instance of this.instances) {
      if (!instance.visible || this.look_of(instance) === 'ghost') continue;
      for (const mesh of instance.surfaces) owner.set(mesh, instance);
    }
    const [hit] = ray.intersectObjects([...owner.keys()], false);
    return hit ? owner.get(hit.object) : null;
  }

  // -- looks ------------------------------------------------------------------------------------

  look_of(instance) {
    if (instance === this.selected) return 'selected';
    if (instance === this.hovered) return 'hover';
    if (this.xray && instance.state !== 'colliding') return 'ghost';
    return 'own';
  }

  material_in(look, own) {
    if (look === 'own') return own;
    const key = `${look} ${own.uuid}`;
    if (!this.looks.has(key)) {
      const material = own.clone();
      LOOKS[look](material);
      this.looks.set(key, material);
    }
    return this.looks.get(key);
  }

  update_looks() {
    for (const instance of this.instances) {
      instance.object.visible = instance.visible;
      const look = this.look_of(instance);
      for (const drawn of instance.surfaces) drawn.material = this.material_in(look, drawn.own_material);
      for (const drawn of instance.lines) {
        drawn.material = this.material_in(look, drawn.own_material);
        drawn.visible = this.show_edges;
      }
    }
    this.request_frame();
  }

  // -- camera -----------------------------------------------------------------------------------

  box_of(instances) {
    const box = new Box3();
    for (const instance of instances) {
      box.union(instance.box ?? new Box3().setFromObject(instance.object));
    }
    return box.isEmpty() ? new Box3(new Vector3(-0.05, -0.05, -0.05), new Vector3(0.05, 0.05, 0.05)) : box;
  }

  direction() {
    return this.camera.position.clone().sub(this.controls.target).normalize();
  }

  view(name, { turn = true } = {}) {
    this.frame(this.shown(), { direction: VIEWS[name].clone().normalize(), turn });
  }

  shown() {
    return this.instances.filter((instance) => instance.visible);
  }

  // Moves until `instances` fill the view, less a margin, as seen against `direction`. They go on
  // filling it when the window changes, until the user moves the camera.
  frame(instances, { direction = this.direction(), margin = FIT_MARGIN, turn = true } = {}) {
    this.framed = { instances, direction, margin };
    const goal = this.goal_of(this.framed);
    if (!turn) {
      this.place(goal);
      return;
    }
    const now = {
      direction: this.direction(),
      target: this.controls.target.clone(),
      half_height: this.half_height / this.camera.zoom,
    };
    this.turn = { from: now, to: goal, start: performance.now() };
    this.request_frame();
  }

  frame_with_context(instance) {
    this.frame([instance], { margin: CONTEXT_MARGIN });
  }

  goal_of({ instances, direction, margin }) {
    const box = this.box_of(instances);
    const target = box.getCenter(new Vector3());
    const probe = new OrthographicCamera();
    probe.position.copy(direction);
    probe.lookAt(0, 0, 0);
    const to_view = probe.quaternion.invert();
    const seen = new Box3();
    for (const x of [box.min.x, box.max.x]) {
      for (const y of [box.min.y, box.max.y]) {
        for (const z of [box.min.z, box.max.z]) {
          seen.expandByPoint(new Vector3(x, y, z).sub(target).applyQuaternion(to_view));
        }
      }
    }
    const size = seen.getSize(new Vector3());
    const half_height = 0.5 * margin * Math.max(size.y, size.x / this.aspect, 1e-4);
    return { direction, target, half_height };
  }

  place({ direction, target, half_height }) {
    // Far enough that nothing is behind the camera, whatever the user turns to.
    const all = this.box_of(this.instances);
    const reach = all.getSize(new Vector3()).length() + all.getCenter(new Vector3()).distanceTo(target);
    this.half_height = half_height;
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, 2 * reach);
    Object.assign(this.camera, { near: 0, far: 4 * reach, zoom: 1 });
    this.update_projection();
    this.controls.update();
    this.request_frame();
  }

  step_turn(now) {
    const { from, to, start } = this.turn;
    const t = Math.min(1, Math.max(0, (now - start) / TURN_MS));
    const s = t * t * (3 - 2 * t);
    const direction = from.direction.clone().lerp(to.direction, s);
    if (direction.lengthSq() < 1e-6) direction.copy(to.direction); // opposite ways
    this.place({
      direction: direction.normalize(),
      target: from.target.clone().lerp(to.target, s),
      half_height: from.half_height * (to.half_height / from.half_height) ** s,
    });
    if (t === 1) this.turn = null;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.aspect = width / height;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.update_projection();
    if (this.framed) {
      const goal = this.goal_of(this.framed);
      if (this.turn) this.turn.to = goal;
      else this.place(goal);
    }
    this.request_frame();
  }

  update_projection() {
    Object.assign(this.camera, {
      left: -this.half_height * this.aspect,
      right: this.half_height * this.aspect,
      top: this.half_height,
      bottom: -this.half_height,
    });
    this.camera.updateProjectionMatrix();
  }

  // Draws once, soon: nothing is drawn while nothing changes.
  request_frame() {
    if (this.frame_requested) return;
    this.frame_requested = true;
    requestAnimationFrame((now) => {
      this.frame_requested = false;
      if (this.turn) this.step_turn(now);
      this.renderer.render(this.scene, this.camera);
      this.triad.update(this.camera);
      const height_mm = (2000 * this.half_height) / this.camera.zoom;
      this.scale.update(height_mm / this.canvas.parentElement.clientHeight);
    });
  }
}
