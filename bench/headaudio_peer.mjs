// What HeadAudio (npm package @met4citizen/headaudio, MIT) makes of a recording: its own modules run as in a page, block
// after block of 128 samples, without waiting for time.
//
//   node headaudio_peer.mjs PACKAGE FILE.f32 [mended]
//
// FILE.f32: mono, 48 kHz, 32-bit floats. Prints CSV: ms and the 15 blend-shape values, each 10 ms. Its node ignores
// viseme 0 (aa) in version 0.1.0, since it takes 0 for nothing; `mended` takes it for aa.
import fs from "node:fs";
import path from "node:path";

const [folder, file, mended] = process.argv.slice(2);
const RATE = 48000, BLOCK = 128, STEP_MS = 10;

// The few names of a browser that the modules use, both ends of the port joined directly.
let worklet = null;
globalThis.sampleRate = RATE;
globalThis.AudioWorkletProcessor = class {
  constructor() { this.port = { onmessage: null, postMessage: (data) => node.port.onmessage({ data }) }; }
};
globalThis.AudioWorkletNode = class {
  constructor() { this.port = { onmessage: null, postMessage: (data) => worklet.port.onmessage({ data }) }; }
};
let Worklet = null;
globalThis.registerProcessor = (name, type) => { Worklet = type; };
globalThis.fetch = async (location) => {
  const bytes = fs.readFileSync(location);
  return { ok: true, arrayBuffer: async () => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length) };
};

const module = (name) => import(path.resolve(folder, "modules", name));
const { HeadAudio } = await module("headaudio.mjs");
await module("headworklet.mjs");
let node = new HeadAudio(null);
worklet = new Worklet({ processorOptions: {} });
await node.loadModel(path.resolve(folder, "dist", "model-en-mixed.bin"));
if (mended) {
  const receive = node.port.onmessage;
  node.port.onmessage = (message) => {
    receive(message);
    if (message.data.event === "viseme" && message.data.viseme === 0) node.visemeActive = 0;
  };
}
const value = Object.fromEntries(node.visemeNames.map((name) => [name, 0]));
node.onvalue = (name, now) => { value[name] = now; };

const parameters = {};
for (const of of Worklet.parameterDescriptors) parameters[of.name] = new Float32Array([of.defaultValue]);
const bytes = fs.readFileSync(file);
const samples = new Float32Array(bytes.buffer, bytes.byteOffset, Math.floor(bytes.length / 4));
console.log(["ms", ...node.visemeNames].join(","));
let shown = 0;
for (let at = 0; at + BLOCK <= samples.length; at += BLOCK) {
  worklet.process([[samples.subarray(at, at + BLOCK)]], [], parameters);
  for (const ms = 1000 * (at + BLOCK) / RATE; shown + STEP_MS <= ms;) {
    shown += STEP_MS;
    node.update(STEP_MS);
    console.log([shown, ...node.visemeNames.map((name) => value[name].toFixed(3))].join(","));
  }
}
