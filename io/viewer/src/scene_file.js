// Reads the scene that dowel has put into the page.

import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

function bytes_of(base64) {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

// An instance as the page knows it. `surfaces` and `lines` are what three.js draws of it.
function to_instance(object, nodes, meshes) {
  const node = nodes[object.node_index];
  const surfaces = [];
  const lines = [];
  object.traverse((child) => {
    if (child.isMesh) surfaces.push(child);
    if (child.isLineSegments) lines.push(child);
  });
  return {
    name: node.name ?? '',
    part: node.mesh === undefined ? '' : meshes[node.mesh].name ?? '',
    state: node.extras?.state ?? 'normal',
    note: node.extras?.note ?? '',
    object,
    surfaces,
    lines,
    visible: true,
  };
}

// Returns { root, instances }: what three.js draws, and the list of what is in it, in file order.
export async function read_scene(element) {
  const gltf = await new GLTFLoader().parseAsync(bytes_of(element.textContent), '');
  const { json, associations } = gltf.parser;
  // Names and order come from the file itself: three.js strips characters from object names.
  const objects = [];
  gltf.scene.traverse((object) => {
    const index = associations.get(object)?.nodes;
    if (index === undefined || objects[index]) return;
    object.node_index = index;
    objects[index] = object;
  });
  const order = json.scenes[json.scene].nodes ?? [];
  const instances = order.map((index) => to_instance(objects[index], json.nodes, json.meshes));
  return { root: gltf.scene, instances };
}
