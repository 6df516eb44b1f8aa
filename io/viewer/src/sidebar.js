// The list of instances.

const SECTIONS = [
  { state: 'colliding', title: 'Colliding' },
  { state: 'contact', title: 'In contact' },
  { state: 'normal', title: 'Clear' },
];

function make(tag, class_name, text) {
  const element = document.createElement(tag);
  if (class_name) element.className = class_name;
  if (text !== undefined) element.textContent = text; // never as HTML: names come from files
  return element;
}

function counted(count, one, many) {
  return `${count} ${count === 1 ? one : many}`;
}

export class Sidebar {
  constructor(instances) {
    this.instances = instances;
    this.rows = new Map();
    this.on_select = () => {};
    this.on_hover = () => {};
    this.on_show = () => {};
    this.list = document.getElementById('list');
    this.search = document.getElementById('search');
    document.querySelector('#sidebar h1').textContent = document.title;
    this.show_counts();
    this.fill();
    this.search.hidden = instances.length < 8;
    this.search.addEventListener('input', () => this.filter());
  }

  with_state(state) {
    return this.instances.filter((instance) => instance.state === state);
  }

  show_counts() {
    const parts = new Set(this.instances.map((instance) => instance.part)).size;
    const colliding = this.with_state('colliding').length;
    const counts = document.getElementById('counts');
    counts.append(
      `${counted(this.instances.length, 'instance', 'instances')} of ${counted(parts, 'part', 'parts')}`);
    if (colliding > 0) counts.append(make('strong', '', `${colliding} colliding`));
  }

  fill() {
    const sections = SECTIONS.map(({ state, title }) => ({ state, title, members: this.with_state(state) }))
      .filter(({ members }) => members.length > 0);
    for (const { state, title, members } of sections) {
      const section = make('section', state);
      // One section alone needs no heading that says so.
      if (sections.length > 1) {
        const heading = make('h2', '', title);
        heading.append(make('span', '', String(members.length)));
        section.append(heading);
      }
      const list = make('ul');
      for (const instance of members) list.append(this.make_row(instance));
      section.append(list);
      this.list.append(section);
    }
  }

  make_row(instance) {
    const row = make('li');
    const eye = make('button', 'eye');
    eye.addEventListener('click', () => this.on_show(instance, !instance.visible));
    const entry = make('button', 'entry');
    entry.append(make('span', 'name', instance.name || '(no name)'));
    if (instance.part && instance.part !== instance.name) entry.append(make('span', 'part', instance.part));
    if (instance.note) entry.append(make('span', 'note', instance.note));
    entry.addEventListener('click', () => this.on_select(instance));
    row.addEventListener('pointerenter', () => this.on_hover(instance));
    row.addEventListener('pointerleave', () => this.on_hover(null));
    row.append(eye, entry);
    this.rows.set(instance, { row, eye });
    return row;
  }

  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const [instance, { row }] of this.rows) {
      const text = `${instance.name} ${instance.part} ${instance.note}`.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
    }
    for (const section of this.list.children) {
      section.hidden = [...section.querySelectorAll('li')].every((row) => row.hidden);
    }
  }

  update(selected) {
    for (const [instance, { row, eye }] of this.rows) {
      row.classList.toggle('selected', instance === selected);
      row.classList.toggle('off', !instance.visible);
      eye.title = instance.visible ? 'Hide' : 'Show';
      eye.setAttribute('aria-label', `${eye.title} ${instance.name}`);
      eye.setAttribute('aria-pressed', String(instance.visible));
    }
  }

  reveal(instance) {
    this.rows.get(instance)?.row.scrollIntoView({ block: 'nearest' });
  }
}
