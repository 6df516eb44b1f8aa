// Builds the page template: one HTML file with the script and the style inside it, and two places
// left for dowel to fill in: the title and the scene.
//
//   node build.mjs OUTPUT.html

import { createHash } from 'node:crypto';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import process from 'node:process';

import { build } from 'esbuild';

const output = resolve(process.argv[2] ?? 'build/page.html');

async function bundle(entry) {
  const result = await build({
    entryPoints: [new URL(entry, import.meta.url).pathname],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: ['es2020'],
    charset: 'ascii', // the template survives any encoding on its way into the program
    legalComments: 'eof', // three.js asks for its notice to stay
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

// three.js names its own documentation in messages. The page must not hold any address that a
// browser could be made to open, only the namespaces that SVG and XHTML elements are created with.
function without_addresses(script) {
  return script.replace(/https?:\/\/(?!www\.w3\.org\/)[^\s"'`)\\]*/g, '(address removed)');
}

const script = without_addresses(await bundle('src/main.js'));
const style = await bundle('src/style.css');
const page = await readFile(new URL('src/page.html', import.meta.url), 'utf8');

// The policy names the one script that may run by its hash: whatever stood in a title or a name
// could not run, and nothing can be loaded from anywhere.
const script_hash = createHash('sha256').update(script).digest('base64');
const parts = { STYLE: style, SCRIPT: script, SCRIPT_HASH: script_hash };
const html = page.replace(/@(STYLE|SCRIPT|SCRIPT_HASH)@/g, (_, name) => parts[name]);

for (const place of ['@TITLE@', '@SCENE@']) {
  if (html.split(place).length !== 2) {
    throw new Error(`${place} must stand in the page exactly once`);
  }
}
if (script.includes('</script') || style.includes('</style')) {
  throw new Error('the script or the style would end its own element');
}

await mkdir(dirname(output), { recursive: true });
await writeFile(output, html);
