// OpenAI's own client against the gateway's speech and the stand-in for a model:
//     node openai.mjs http://HOST:PORT TOKEN http://HOST:PORT-OF-THE-STAND-IN
import assert from "node:assert/strict";
import OpenAI from "openai";

const [gateway, token, model] = process.argv.slice(2);
const client = new OpenAI({ baseURL: gateway + "/v1", apiKey: token, maxRetries: 0 });
const input = "Good morning. My name is Galatea.";

async function speech(more) {
  const answer = await client.audio.speech.create({ model: "any", voice: "slt", input, ...more });
  return { type: answer.headers.get("content-type"), bytes: Buffer.from(await answer.arrayBuffer()) };
}

const wav = await speech({ response_format: "wav" });
assert.equal(wav.type, "audio/wav");
assert.equal(wav.bytes.subarray(0, 4).toString(), "RIFF");
const pcm = await speech({ response_format: "pcm" });
assert.ok(Math.abs(pcm.bytes.length - (wav.bytes.length - 44) * 1.5) <= 4, "24 kHz");
for (const [response_format, begin] of [[undefined, null], ["mp3", null], ["opus", "OggS"], ["flac", "fLaC"], ["aac", null]]) {
  const sound = await speech({ response_format });
  assert.ok(sound.bytes.length > 1000, response_format);
  if (begin) assert.equal(sound.bytes.subarray(0, 4).toString(), begin);
}
assert.ok((await speech({ response_format: "wav", speed: 2 })).bytes.length < wav.bytes.length * 0.7);

// As a stream, piece by piece.
const streamed = await client.audio.speech.create({ model: "any", voice: "", input, response_format: "pcm" });
let bytes = 0;
for await (const piece of streamed.body) bytes += piece.length;
assert.equal(bytes, pcm.bytes.length);

// Our addition, by the client's way for what it does not know.
const seen = await client.post("/audio/speech", {
  body: { model: "any", voice: "slt", input, response_format: "wav", visemes: "oculus15", fps: 25 } });
assert.equal(seen.names.length, 15);
assert.ok(Math.abs(seen.frames.length - seen.duration * 25) <= 2);
assert.equal(Buffer.from(seen.audio, "base64").length, wav.bytes.length);

// Mistakes are the client's own classes, with our words.
await assert.rejects(speech({ voice: "nobody" }), (e) => e instanceof OpenAI.BadRequestError && /nobody/.test(e.message));
await assert.rejects(speech({ input: "x".repeat(9000) }), (e) => e.status === 413 && /8192/.test(e.message));
await assert.rejects(speech({ response_format: "ogg" }), (e) => e.status === 400 && /response_format/.test(e.message));
const stranger = new OpenAI({ baseURL: gateway + "/v1", apiKey: "wrong-wrong-wrong", maxRetries: 0 });
await assert.rejects(stranger.audio.speech.create({ model: "any", voice: "", input }),
                     (e) => e instanceof OpenAI.AuthenticationError);

// The stand-in that tests of chat answer by is read as a model's answer is.
const talk = new OpenAI({ baseURL: model + "/v1", apiKey: "any", maxRetries: 0 });
const stream = await talk.chat.completions.create({ model: "echo", stream: true, messages: [{ role: "user", content: "hello" }] });
let text = "";
let reason = null;
for await (const chunk of stream) {
  text += chunk.choices[0]?.delta?.content ?? "";
  reason = chunk.choices[0]?.finish_reason ?? reason;
}
assert.match(text, /hello/);
assert.equal(reason, "stop");
console.log("openai: ok");
