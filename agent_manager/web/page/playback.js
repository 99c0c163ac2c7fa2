// Shows what is seen of the face and plays what is heard of the voice, in step: both streams carry the session's time,
// and each piece is presented at its time plus one delay that both share.
const kPictureKind = 1, kSoundKind = 2, kSilenceKind = 3;
const kHeaderBytes = 16;
const kFirstDelayMs = 200, kLeastDelayMs = 100, kMostDelayMs = 600;
const kSpareMs = 25;           // beyond the lateness of nearly all pictures
const kDelayStepMs = 15;       // smaller changes are not worth it
const kContinuousMs = 20;      // pieces of sound whose times fit so well are played end to end
const kMostPictures = 20;      // that wait, 0.8 s
const kSilentFaceMs = 2000;    // without a picture for so long, the face is said to draw nothing
const kStamps = 15;
const kSettledMs = 500;        // a stream that has stayed open for so long is one

const median = numbers => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];

// The session's clock, as the page's (performance.now). Of several questions the answer that came fastest counts, since
// it is wrong by half of its journey at most.
export class SessionClock {
  constructor(hub) {
    this.hub = hub;
    this.best = null;
  }
  get known() { return this.best !== null; }
  // After each connection, since another hub has another clock.
  async start() {
    this.best = null;
    for (let i = 0; i < 8; ++i) await this.measure();
  }
  async measure() {
    const asked = performance.now();
    const value = Number(await this.hub.ask('inq Clock').catch(() => NaN));
    const answered = performance.now();
    if (!Number.isFinite(value)) return;
    // A measurement grows old, so that clocks that drift are followed.
    const age = this.best ? (answered - this.best.at) / 1000 : 0;
    const journey = answered - asked;
    if (!this.best || journey <= this.best.journey + age * 0.05)
      this.best = {journey, at: answered, offset: value - (asked + answered) / 2};
  }
  now() { return performance.now() + this.best.offset; }
  toPage(session_ms) { return session_ms - this.best.offset; }
}

// How much later than the session's time everything is presented. It follows the pictures' lateness, and only while
// the voice is silent, so that no word is stretched or cut.
export class Delay {
  constructor() {
    this.ms = kFirstDelayMs;
    this.lateness = [];
  }
  note(late_ms) {
    this.lateness.push(late_ms);
    if (this.lateness.length > 100) this.lateness.shift();
  }
  adapt() {
    if (this.lateness.length < 25) return;
    const sorted = [...this.lateness].sort((a, b) => a - b);
    const wanted = sorted[Math.floor(sorted.length * 0.95)] + kSpareMs;
    const allowed = Math.min(kMostDelayMs, Math.max(kLeastDelayMs, wanted));
    if (Math.abs(allowed - this.ms) > kDelayStepMs) this.ms = allowed;
  }
}

// A WebSocket of pieces that is opened again a second after each end. onEnd is told the reason, onOpen that it is there.
class Stream {
  constructor(path, onPiece, onEnd, onOpen = () => {}) {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    this.open = () => {
      const socket = new WebSocket(`${scheme}//${location.host}/${path}`);
      socket.binaryType = 'arraybuffer';
      socket.onmessage = ({data}) => {
        const head = new DataView(data, 0, kHeaderBytes);
        onPiece({kind: head.getUint8(0), rate: head.getUint32(4, true), at: head.getFloat64(8, true),
                 bytes: data.slice(kHeaderBytes)});
      };
      let settled = null;
      socket.onopen = () => { settled = setTimeout(onOpen, kSettledMs); };
      socket.onclose = event => {
        clearTimeout(settled);
        onEnd(event.reason);
        setTimeout(this.open, 1000);
      };
    };
    this.open();
  }
}

// Draws pictures on a canvas. onState is told '' when there are pictures, else why there are none (null: unknown).
export class FacePlayer {
  constructor(canvas, clock, delay, onState) {
    Object.assign(this, {canvas, clock, delay, onState});
    this.waiting = [];
    this.shown_at = -Infinity;  // the session's time of the last picture
    this.drawn = performance.now();
    this.alive = null;
    this.onDraw = () => {};
    this.stream = new Stream('face', piece => this.take(piece), reason => this.lose(reason || null));
    const draw = () => {
      this.draw();
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
    setInterval(() => {
      if (!clock.known || document.hidden) this.drawn = performance.now();
      const silent = performance.now() - this.drawn > kSilentFaceMs;
      if (silent && this.alive !== false) this.lose('the face draws nothing');
    }, 500);
  }

  async take({kind, at, bytes}) {
    if (kind !== kPictureKind || !this.clock.known) return;
    const picture = await createImageBitmap(new Blob([bytes], {type: 'image/jpeg'})).catch(() => null);
    if (!picture || !this.clock.known) return;
    this.delay.note(this.clock.now() - at);
    // A face that starts anew, or another hub, begins with earlier times.
    if (at < this.shown_at - 1000) this.clear();
    this.waiting.push({at, picture});
    this.waiting.sort((a, b) => a.at - b.at);
    while (this.waiting.length > kMostPictures) this.waiting.shift().picture.close();
  }

  draw() {
    if (!this.clock.known) return;
    const due = this.clock.now() - this.delay.ms;
    let next = null;
    while (this.waiting.length && this.waiting[0].at <= due) {
      if (next) next.picture.close();
      next = this.waiting.shift();
    }
    if (!next) return;
    const {picture, at} = next;
    if (this.canvas.width !== picture.width) this.canvas.width = picture.width;
    if (this.canvas.height !== picture.height) this.canvas.height = picture.height;
    this.canvas.getContext('2d').drawImage(picture, 0, 0);
    picture.close();
    this.shown_at = at;
    this.drawn = performance.now();
    this.onDraw(at, due - at);
    if (this.alive === true) return;
    this.alive = true;
    this.onState('');
  }

  clear() {
    for (const {picture} of this.waiting) picture.close();
    this.waiting = [];
    this.shown_at = -Infinity;
  }
  lose(reason) {
    this.clear();
    this.alive = false;
    this.onState(reason);
  }
}

// Plays pieces of sound. onState is told '' while there is a voice to be heard, else why there is none.
export class VoicePlayer {
  constructor(clock, delay, onState) {
    Object.assign(this, {clock, delay, onState});
    this.context = new AudioContext({sampleRate: 16000, latencyHint: 'interactive'});
    this.gain = this.context.createGain();
    this.gain.connect(this.context.destination);
    this.stamps = [];     // context time minus page time, s
    this.playing = [];    // {source, at: session's ms, starts, ends: context's s}
    this.next = null;     // where the next piece goes: {at, starts}
    this.stream = new Stream('voice', piece => this.take(piece), reason => {
      this.stop();
      onState(reason || null);
    }, () => onState(''));
    setInterval(() => this.tick(), 200);
  }

  get allowed() { return this.context.state === 'running'; }
  // Browsers let a page sound only after its user has done something.
  allow() { return this.context.resume(); }
  set loud(on) { this.gain.gain.value = on ? 1 : 0; }

  tick() {
    this.stamp();
    const now = this.context.currentTime;
    this.playing = this.playing.filter(({ends}) => ends > now - 1);
    if (!this.playing.some(({ends}) => ends > now)) {
      this.next = null;
      this.delay.adapt();
    }
  }

  stamp() {
    const {contextTime, performanceTime} = this.context.getOutputTimestamp();
    if (!this.allowed || !contextTime) return;
    this.stamps.push(contextTime - performanceTime / 1000);
    if (this.stamps.length > kStamps) this.stamps.shift();
  }

  // When, on the context's clock, what has the session's time `ms` shall be heard.
  placeOf(ms) {
    const page_s = (this.clock.toPage(ms) + this.delay.ms) / 1000;
    return this.stamps.length
        ? page_s + median(this.stamps)
        : this.context.currentTime + page_s - performance.now() / 1000 - (this.context.outputLatency || 0);
  }

  take({kind, rate, at, bytes}) {
    if (!this.clock.known) return;
    if (kind === kSilenceKind) return this.endAt(at);
    if (kind !== kSoundKind || !this.allowed || bytes.byteLength < 2) return;
    this.stamp();
    const samples = new Int16Array(bytes);
    const buffer = this.context.createBuffer(1, samples.length, rate);
    const channel = buffer.getChannelData(0);
    for (let i = 0; i < samples.length; ++i) channel[i] = samples[i] / 32768;
    const joins = this.next && Math.abs(this.next.at - at) < kContinuousMs;
    const starts = joins ? this.next.starts : this.placeOf(at);
    const ends = starts + buffer.duration;
    this.next = {at: at + buffer.duration * 1000, starts: ends};
    // What should have been heard already is left out, so that the rest is in step.
    const late = Math.max(0, this.context.currentTime - starts);
    if (late >= buffer.duration) return;
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.gain);
    source.start(starts + late, late);
    this.playing.push({source, at, starts, ends});
  }

  // What was sent of later times is void.
  endAt(at) {
    for (const piece of this.playing) {
      const stop = piece.starts + (at - piece.at) / 1000;
      if (stop >= piece.ends) continue;
      piece.source.stop(Math.max(0, stop));
      piece.ends = stop;
    }
    this.next = null;
  }
  stop() {
    for (const {source} of this.playing) source.stop();
    this.playing = [];
    this.next = null;
  }
}
