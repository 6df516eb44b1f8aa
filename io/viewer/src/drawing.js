// What is drawn over the 3D view: the axes of the world and a scale.

import { Quaternion, Vector3 } from 'three';

const SVG = 'http://www.w3.org/2000/svg';

// The assembly's axes (z up) in the frame of the view (y up).
const AXES = [
  { label: 'x', colour: '#d23b3b', direction: new Vector3(1, 0, 0) },
  { label: 'y', colour: '#2f9a4c', direction: new Vector3(0, 0, -1) },
  { label: 'z', colour: '#2f6bd8', direction: new Vector3(0, 1, 0) },
];

function svg_element(name, attributes) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

export class Triad {
  constructor(svg) {
    this.svg = svg;
    this.axes = AXES.map((axis) => {
      const group = svg_element('g', {});
      const line = svg_element('line', { stroke: axis.colour, 'stroke-width': 2.5, 'stroke-linecap': 'round' });
      const text = svg_element('text', { fill: axis.colour });
      text.textContent = axis.label;
      group.append(line, text);
      return { ...axis, group, line, text };
    });
  }

  update(camera) {
    const to_view = new Quaternion().copy(camera.quaternion).invert();
    for (const axis of this.axes) {
      axis.seen = axis.direction.clone().applyQuaternion(to_view);
      const { x, y } = axis.seen;
      axis.line.setAttribute('x2', 30 * x);
      axis.line.setAttribute('y2', -30 * y);
      axis.text.setAttribute('x', 40 * x);
      axis.text.setAttribute('y', -40 * y);
      // An axis that points at the viewer is a dot: its letter would hide the others.
      axis.text.setAttribute('opacity', Math.hypot(x, y) < 0.2 ? 0 : 1);
    }
    const far_to_near = [...this.axes].sort((a, b) => a.seen.z - b.seen.z);
    this.svg.replaceChildren(...far_to_near.map((axis) => axis.group));
  }
}

// The longest of 1, 2, 5 times a power of ten that is not longer than `limit`.
export function round_length(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].find((factor) => factor * power <= limit) * power;
}

function to_text(length_mm) {
  if (length_mm >= 1000) return `${length_mm / 1000} m`;
  return length_mm >= 1 ? `${length_mm} mm` : `${Number((1000 * length_mm).toPrecision(1))} µm`;
}

export class ScaleBar {
  constructor(element) {
    this.element = element;
    this.label = element.querySelector('span');
  }

  update(mm_per_pixel) {
    const length_mm = round_length(120 * mm_per_pixel);
    this.element.style.width = `${length_mm / mm_per_pixel}px`;
    this.label.textContent = to_text(length_mm);
  }
}
