// The browser's microphone as the input of the ear, @SRM. Nothing is recognised elsewhere: the
// samples go to the hub, and what was said comes back as the ear's Result.
export class Microphone {
  // onEnd is told why it has ended; '' when it was asked to. onLevel is told the loudest sample, 0 to 32767, of each
  // tenth of a second.
  constructor(onEnd = () => {}, onLevel = () => {}) {
    this.onEnd = onEnd;
    this.onLevel = onLevel;
  }
  get on() { return Boolean(this.stream); }

  async start() {
    if (!navigator.mediaDevices) throw new Error('this browser gives pages no microphone');
    this.stream = await navigator.mediaDevices.getUserMedia(
        {audio: {channelCount: 1, echoCancellation: true, noiseSuppression: false}});
    try {
      this.context = new AudioContext({sampleRate: 16000});
      await this.context.audioWorklet.addModule('microphone_worklet.js');
      const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
      this.socket = new WebSocket(`${scheme}//${location.host}/microphone`);
      await new Promise((opened, failed) => {
        this.socket.onopen = opened;
        this.socket.onerror = () => failed(new Error('the hub takes no sound (is another page heard?)'));
      });
      this.socket.onerror = null;
      this.socket.onclose = event => this.end(event.reason || 'the hub has gone');
      const worklet = new AudioWorkletNode(this.context, 'samples', {numberOfOutputs: 0});
      worklet.port.onmessage = event => {
        this.onLevel(new Int16Array(event.data).reduce((most, sample) => Math.max(most, Math.abs(sample)), 0));
        if (this.socket && this.socket.bufferedAmount < 64000) this.socket.send(event.data);
      };
      this.context.createMediaStreamSource(this.stream).connect(worklet);
      await this.context.resume();
    } catch (error) {
      this.end();
      throw error;
    }
  }

  stop() { this.end(''); }

  end(why) {
    const socket = this.socket;
    this.socket = null;
    if (socket) {
      socket.onclose = null;
      socket.close();
    }
    if (this.context) this.context.close();
    if (this.stream) for (const track of this.stream.getTracks()) track.stop();
    this.context = this.stream = null;
    if (why !== undefined) this.onEnd(why);
  }
}
