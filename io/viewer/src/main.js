// Wires the list, the buttons and the 3D view together.

import { read_scene } from './scene_file.js';
import { Sidebar } from './sidebar.js';
import { Stage } from './stage.js';

function show_notice(title, text) {
  const notice = document.getElementById('notice');
  notice.querySelector('h2').textContent = title;
  notice.querySelector('p').textContent = text;
  notice.hidden = false;
}

function make_stage(scene) {
  try {
    return new Stage(document.getElementById('canvas'), scene);
  } catch (error) {
    console.error(error);
    document.body.classList.add('flat');
    show_notice(
      'No 3D view',
      'This browser or machine offers no WebGL, which the picture needs. The list of instances works without it.');
    return null;
  }
}

class Page {
  constructor(scene) {
    this.instances = scene.instances;
    this.sidebar = new Sidebar(scene.instances);
    this.stage = make_stage(scene);
    this.selected = null;
    this.commands = {
      fit: () => this.stage?.frame(this.selected ? [this.selected] : this.stage.shown()),
      'show-all': () => this.show_only(this.instances),
      isolate: () => this.selected && this.show_only([this.selected]),
      hide: () => this.selected && this.show(this.selected, !this.selected.visible),
    };
    this.toggles = {
      edges: (on) => { this.stage.show_edges = on; },
      xray: (on) => { this.stage.xray = on; },
      grid: (on) => { this.stage.grid.visible = on; },
    };
    this.listen();
    this.update();
  }

  listen() {
    this.sidebar.on_show = (instance, visible) => this.show(instance, visible);
    this.sidebar.on_select = (instance) => {
      this.select(instance === this.selected ? null : instance);
      if (this.selected) this.stage?.frame_with_context(instance);
      else this.stage?.frame(this.stage.shown());
    };
    this.sidebar.on_hover = (instance) => {
      if (!this.stage) return;
      this.stage.hovered = instance;
      this.stage.update_looks();
    };
    if (this.stage) {
      this.stage.on_pick = (instance) => this.select(instance);
    }
    for (const button of document.querySelectorAll('button[data-view]')) {
      button.addEventListener('click', () => this.stage?.view(button.dataset.view));
    }
    for (const button of document.querySelectorAll('button[data-command]')) {
      button.addEventListener('click', () => this.commands[button.dataset.command]());
    }
    for (const button of document.querySelectorAll('button[data-toggle]')) {
      button.addEventListener('click', () => this.toggle(button));
    }
    document.addEventListener('keydown', (event) => this.on_key(event));
  }

  on_key(event) {
    if (event.target.matches('input') || event.ctrlKey || event.metaKey || event.altKey) return;
    const press = (selector) => document.querySelector(selector).click();
    const keys = {
      1: () => press('[data-view=iso]'),
      2: () => press('[data-view=top]'),
      3: () => press('[data-view=front]'),
      4: () => press('[data-view=right]'),
      f: () => press('[data-command=fit]'),
      h: () => press('[data-command=hide]'),
      i: () => press('[data-command=isolate]'),
      e: () => press('[data-toggle=edges]'),
      x: () => press('[data-toggle=xray]'),
      g: () => press('[data-toggle=grid]'),
      Escape: () => this.select(null),
    };
    keys[event.key]?.();
  }

  toggle(button) {
    if (!this.stage) return;
    const on = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(on));
    this.toggles[button.dataset.toggle](on);
    this.stage.update_looks();
  }

  select(instance) {
    this.selected = instance;
    this.update();
    this.sidebar.reveal(instance);
  }

  show(instance, visible) {
    instance.visible = visible;
    this.update();
  }

  show_only(shown) {
    const visible = new Set(shown);
    for (const instance of this.instances) instance.visible = visible.has(instance);
    this.update();
  }

  update() {
    this.sidebar.update(this.selected);
    for (const name of ['isolate', 'hide']) {
      document.querySelector(`[data-command=${name}]`).disabled = !this.selected;
    }
    if (!this.stage) return;
    this.stage.selected = this.selected;
    this.stage.update_looks();
  }
}

read_scene(document.getElementById('scene'))
  .then((scene) => new Page(scene))
  .catch((error) => {
    console.error(error);
    show_notice('The scene cannot be read', 'This page is damaged: write it again with dowel.');
  });
