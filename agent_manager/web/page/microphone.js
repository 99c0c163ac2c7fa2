// The browser's microphone as the input of the ear, @SRM. Nothing is recognised elsewhere: the
// samples go to the hub, and what was said comes back as the ear's Result.
const kMostKept = 200;            // pieces, of a tenth of a second, that wait for the hub
const kMostUnsentBytes = 700000;  // of sound that the hub has not taken, 20 s

export class Microphone {
  // onEnd is told why it has ended; '' when it was asked to. onLevel is told the loudest sample, 0 to 32767, of each
  // tenth of a second. onReady: from now on the ear takes what it hears; until then that is kept.
  constructor(onEnd = () => {}, onLevel = () => {}, onReady = () => {}) {
    this.onEnd = onEnd;
    this.onLevel = onLevel;
    this.onReady = onReady;
  }
  get on() { return Boolean(this.context); }

  // What takes its time comes before the microphone is opened, or after it is heard, so that the first words are not lost.
  async start() {
    if (!navigator.mediaDevices) throw new Error('this browser gives pages no microphone');
    const context = this.context = new AudioContext({sampleRate: 16000});
    try {
      await context.audioWorklet.addModule('microphone_worklet.js');
      const stream = await navigator.mediaDevices.getUserMedia(
          {audio: {channelCount: 1, echoCancellation: true, noiseSuppression: false}});
      if (this.context !== context) {  // it was stopped meanwhile
        for (const track of stream.getTracks()) track.stop();
        throw new Error('');
      }
      this.stream = stream;
      this.kept = [];
      const worklet = new AudioWorkletNode(context, 'samples', {numberOfOutputs: 0});
      worklet.port.onmessage = event => this.hear(event.data);
      context.createMediaStreamSource(stream).connect(worklet);
      await context.resume();
      await this.connect();
    } catch (error) {
      const stopped = this.context !== context;
      if (!stopped) this.end();
      throw stopped ? new Error('') : error;
    }
  }

  hear(samples) {
    this.onLevel(new Int16Array(samples).reduce((most, sample) => Math.max(most, Math.abs(sample)), 0));
    if (this.kept) {
      if (this.kept.length < kMostKept) this.kept.push(samples);
    } else if (this.socket && this.socket.bufferedAmount < kMostUnsentBytes) {
      this.socket.send(samples);
    }
  }

  async connect() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = this.socket = new WebSocket(`${scheme}//${location.host}/microphone`);
    socket.onmessage = ({data}) => { if (data === 'READY') this.onReady(); };
    await new Promise((opened, failed) => {
      socket.onopen = opened;
      socket.onerror = () => failed(new Error('the hub takes no sound (is another page heard?)'));
    });
    socket.onerror = null;
    socket.onclose = event => this.end(event.reason || 'the hub has gone');
    for (const samples of this.kept ?? []) socket.send(samples);
    this.kept = null;
  }

  stop() { this.end(''); }

  end(why) {
    const socket = this.socket;
    this.socket = this.kept = null;
    if (socket) {
      socket.onclose = socket.onmessage = null;
      socket.close();
    }
    if (this.context) this.context.close();
    if (this.stream) for (const track of this.stream.getTracks()) track.stop();
    this.context = this.stream = null;
    if (why !== undefined) this.onEnd(why);
  }
}
