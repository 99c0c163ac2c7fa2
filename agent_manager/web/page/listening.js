// The microphone button: what it shows is so, and what is not possible says why.
import {Microphone} from './microphone.js';
import {Refusal} from './galatea.js';
import {put, text} from './texts.js';

const kSilenceMs = 3000;
const kSilentLevel = 30;  // of 32767: a working microphone is never so still

export class Listening {
  // `nodes`: button, state (a text).
  constructor(hub, presence, nodes) {
    Object.assign(this, {hub, presence, nodes});
    this.microphone = new Microphone(why => this.end(why), level => this.level(level), () => {
      this.ear_ready = true;
      this.showListening();
    });
    this.ear_ready = false;   // it takes the sound, and
    this.ear_listens = false; // it listens: only then is it said so
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
  showListening() {
    if (this.microphone.on) this.show(this.ear_ready && this.ear_listens ? 'mic_listening' : 'mic_starting');
  }
  async start() {
    this.ear_ready = this.ear_listens = false;
    this.nodes.button.setAttribute('aria-pressed', 'true');
    this.show('mic_asking');
    try {
      await this.microphone.start();
      this.heard_at = performance.now();
      this.showListening();
      await this.hub.ask('to @SRM set Listen = START', 'u');
      this.ear_listens = true;
      this.showListening();
    } catch (error) {
      this.microphone.end();
      const key = {NotAllowedError: 'mic_denied', NotFoundError: 'mic_missing'}[error.name];
      this.end(key ? text(key) : error.message);
    }
  }
  end(why) {
    this.nodes.button.setAttribute('aria-pressed', 'false');
    if (why) this.show('mic_off', {}), this.nodes.state.textContent = new Refusal(why).words;
    else this.check();
  }
  level(level) {
    const now = performance.now();
    const was_silent = now - this.heard_at > kSilenceMs;
    if (level > kSilentLevel) {
      this.heard_at = now;
      if (was_silent) this.showListening();
    } else if (was_silent) {
      this.show('mic_silent');
    }
  }
  hear({from, slot, value}) {
    if (from !== 'SRM' || !this.microphone.on) return;
    if (slot === 'Listen.stat') value === 'LISTENING' ? this.showListening() : this.show(value === 'SPEECH' ? 'mic_speech' : 'deaf');
    if (slot === 'Result.partial' && value) this.show('mic_speech', {}), this.nodes.state.textContent = `${value} …`;
    if (slot === 'Result') this.showListening();
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
