// The microphone button: what it shows is so, and what is not possible says why.
import {Microphone} from './microphone.js';
import {put, text} from './texts.js';

const kSilenceMs = 3000;
const kSilentLevel = 30;  // of 32767: a working microphone is never so still

export class Listening {
  // `nodes`: button, state (a text).
  constructor(hub, presence, nodes) {
    Object.assign(this, {hub, presence, nodes});
    this.microphone = new Microphone(why => this.end(why), level => this.level(level));
    this.takes_sound = null;  // the ear; null: not known
    this.heard_at = 0;        // when the microphone was last not silent
    nodes.button.onclick = () => (this.microphone.on ? this.microphone.stop() : this.start());
    this.check();
  }

  show(key, values) { put(this.nodes.state, key, values); }
  check() {
    const {button} = this.nodes;
    const why = !this.presence.has('SRM') ? 'mic_no_ear'
        : this.takes_sound === false ? 'mic_typed_ear'
        : !navigator.mediaDevices ? 'mic_none' : '';
    button.disabled = Boolean(why) || this.takes_sound === null;
    if (why || !this.microphone.on) this.show(why || 'mic_off');
  }
  async start() {
    this.nodes.button.setAttribute('aria-pressed', 'true');
    this.show('mic_asking');
    try {
      await this.microphone.start();
      await this.hub.ask('to @SRM set Listen = START', 'u');
      this.heard_at = performance.now();
      this.show('mic_listening');
    } catch (error) {
      this.microphone.end();
      const key = {NotAllowedError: 'mic_denied', NotFoundError: 'mic_missing'}[error.name];
      this.end(key ? text(key) : error.message);
    }
  }
  end(why) {
    this.nodes.button.setAttribute('aria-pressed', 'false');
    if (why) this.show('mic_off', {}), this.nodes.state.textContent = why;
    else this.check();
  }
  level(level) {
    const now = performance.now();
    const was_silent = now - this.heard_at > kSilenceMs;
    if (level > kSilentLevel) {
      this.heard_at = now;
      if (was_silent) this.show('mic_listening');
    } else if (was_silent) {
      this.show('mic_silent');
    }
  }
  hear({from, slot, value}) {
    if (from !== 'SRM' || !this.microphone.on) return;
    if (slot === 'Listen.stat')
      this.show({SPEECH: 'mic_speech', LISTENING: 'mic_listening'}[value] || 'deaf');
    if (slot === 'Result.partial' && value) this.show('mic_speech', {}), this.nodes.state.textContent = `${value} …`;
    if (slot === 'Result') this.show('mic_listening');
    if (slot === 'NoMatch') this.show('not_understood', {what: value});
  }
  async come(name) {
    if (name !== 'SRM') return;
    const slots = await this.hub.ask('to @SRM inq Slots').catch(() => '');
    this.takes_sound = slots.split(/[ ,]+/).includes('Input');
    this.check();
  }
  go(name) {
    if (name !== 'SRM') return;
    this.takes_sound = null;
    if (this.microphone.on) this.microphone.stop();
    this.check();
  }
}
