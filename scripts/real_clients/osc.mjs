// What vmc sends, read by two parsers of OSC that know nothing of us:
//     node osc.mjs BUNDLES       prints the port it listens at, and ends when so many bundles came
import assert from "node:assert/strict";
import dgram from "node:dgram";
import osc from "osc";
import * as oscMin from "osc-min";

const wanted = Number(process.argv[2]);
const socket = dgram.createSocket("udp4");
let count = 0;
const most = {};
socket.on("message", (bytes) => {
  const bundle = osc.readPacket(new Uint8Array(bytes), { metadata: true });
  const same = oscMin.fromBuffer(bytes);
  assert.equal(same.oscType, "bundle");
  assert.equal(bundle.packets.length, same.elements.length);
  bundle.packets.forEach((message, i) => {
    const other = same.elements[i];
    assert.equal(message.address, other.address);
    assert.deepEqual(message.args.map((arg) => arg.value), other.args.map((arg) => arg.value));
    const types = message.args.map((arg) => arg.type).join("");
    const right = { "/VMC/Ext/OK": "i", "/VMC/Ext/T": "f", "/VMC/Ext/Bone/Pos": "sfffffff", "/VMC/Ext/Blend/Val": "sf",
                    "/VMC/Ext/Blend/Apply": "" };
    assert.equal(types, right[message.address], message.address);
    if (message.address === "/VMC/Ext/Blend/Val") {
      const [name, value] = message.args.map((arg) => arg.value);
      assert.ok(value >= 0 && value <= 1, name);
      most[name] = Math.max(most[name] ?? 0, value);
    }
    if (message.address === "/VMC/Ext/Bone/Pos") {
      const [x, y, z, w] = message.args.slice(4).map((arg) => arg.value);
      assert.ok(Math.abs(Math.hypot(x, y, z, w) - 1) < 1e-3, "a rotation");
    }
  });
  assert.equal(bundle.packets.at(-1).address, "/VMC/Ext/Blend/Apply");
  if (++count < wanted) return;
  assert.ok(most.A > 0.3, "the mouth has opened");
  console.log(`osc: ok, ${count} bundles, A up to ${most.A.toFixed(2)}`);
  socket.close();
});
socket.bind(0, "127.0.0.1", () => console.log(socket.address().port));
