// What both say: the log, the subtitles, the line to type in, the button that stops the agent.
import {element, put, text} from './texts.js';

const kMostLines = 300;
const kMostRecalled = 40;  // entries of the history
const kSameMs = 20000;  // within which what was typed is heard
const kMostHeld = 20, kMostHeldMs = 15000, kLookAgainMs = 500;  // so many lines wait so long for modules that are being started

export class Conversation {
  // `nodes`: log, subtitle, status, form, input, stop, way, again.
  constructor(hub, presence, nodes, {voice, delay}) {
    Object.assign(this, {hub, presence, nodes, voice, delay});
    this.sentence = '';     // what the voice has prepared
    this.speaking = null;   // its line in the log
    this.unsaid = '';       // the sentence of the answer that has not sounded yet
    this.read = null;       // the last one that could only be read, and its line
    this.mute = false;      // the voice has failed in this answer
    this.told_away = false; // that the voice is not there
    this.listening = false; // the ear
    this.chat_listens = true;
    this.dialog = '';       // what @DIALOG is at, where there is one
    this.held = [];         // [when, text] of what was typed before the modules were known
    this.typed = [];        // [when, text] of what is in the log already
    nodes.form.onsubmit = event => {
      event.preventDefault();
      this.send();
    };
    nodes.stop.onclick = () => this.stop();
    nodes.again.onclick = () => {
      this.voice.allow();
      this.startDialog('u');
    };
    document.addEventListener('keydown', event => {
      if (event.key === 'Escape' && !document.fullscreenElement && !nodes.form.closest('[hidden]')) this.stop();
    });
    // The log shows its end, also after it has become smaller, unless somebody has scrolled up.
    const {log} = nodes;
    this.at_end = true;
    log.onscroll = () => { this.at_end = log.scrollHeight - log.scrollTop - log.clientHeight < 60; };
    new ResizeObserver(() => { if (this.at_end) log.scrollTop = log.scrollHeight; }).observe(log);
    this.showWay();
  }

  add(who, words) {
    const at_end = who === 'you' || this.at_end;
    const line = element('p', {className: who});
    if (who === 'you' || who === 'agent') {
      const name = element('b');
      put(name, who);
      line.append(name, ' ');
    }
    line.append(element('span', {textContent: words}));
    this.nodes.log.append(line);
    while (this.nodes.log.childElementCount > kMostLines) this.nodes.log.firstChild.remove();
    if (at_end) this.nodes.log.scrollTop = this.nodes.log.scrollHeight;
    return line;
  }

  // ---- what is said to the agent
  get way() {
    if (this.presence.has('DIALOG') && this.dialog !== 'RUNNING') return this.dialog === 'WAITING' ? 'coming' : 'dialog';
    if (this.presence.has('CHAT') && this.chat_listens) return 'chat';
    if (this.presence.lacks('CHAT') && !this.presence.has('DM')) return this.presence.isComing('CHAT') ? 'coming' : 'no_chat';
    if (this.presence.has('SRM') && this.listening) return 'ear';
    if (this.presence.has('CHAT')) return 'chat';
    return this.presence.has('SSM') ? 'voice' : 'none';
  }
  showWay() {
    const {input, way} = this.nodes;
    input.dataset.hint = `hint_${this.way}`;
    input.placeholder = text(input.dataset.hint);
    put(way, this.way === 'chat' && this.presence.lacks('SSM') ? 'way_chat_silent' : `way_${this.way}`);
  }
  send() {
    const words = this.nodes.input.value.trim();
    if (!words) return;
    this.voice.allow();
    if (!this.hub.on) return this.fail(text('away'));
    if (this.held.length >= kMostHeld) return this.fail(text('held_full'));
    this.nodes.input.value = '';
    this.held.push([performance.now(), words]);
    this.sayHeld();
  }
  // What was typed waits until it is known who is there, and for who is being started.
  sayHeld() {
    while (this.hub.on && this.presence.known && this.held.length > 0) {
      const [when, words] = this.held[0];
      const coming = ['CHAT', 'SRM', 'SSM'].some(name => this.presence.isComing(name));
      if (this.way !== 'chat' && coming && performance.now() - when < kMostHeldMs) {
        put(this.nodes.status, 'starting');
        clearTimeout(this.again);
        this.again = setTimeout(() => this.presence.look(), kLookAgainMs);
        return;
      }
      this.held.shift();
      this.say(words);
    }
    if (this.held.length === 0 && this.nodes.status.dataset.text === 'starting') this.clearStatus();
  }
  say(words) {
    const {way} = this;
    const line = {chat: 'to @CHAT set Input.text', ear: 'to @SRM set Input.text', voice: 'to @AM-MCL set Speak'}[way];
    if (way !== 'voice') this.hearUser(words);
    if (!line) return this.fail(text(`way_${way}`));
    // Chat answers when the reply is over; that it was stopped is no failure.
    this.hub.ask(`${line} = ${words}`, 'u').catch(async error => {
      if (error.code === 'STOPPED') return;
      // The refusal may be here before the news that the module has gone.
      if (['UNKNOWN_MODULE', 'UNAVAILABLE'].includes(error.code)) await this.presence.look();
      this.fail(way === 'chat' && !this.presence.has('CHAT') ? text('way_no_chat') : error.message);
    });
  }
  clearStatus() {
    delete this.nodes.status.dataset.text;
    this.nodes.status.replaceChildren();
  }
  stop() {
    this.voice.stop();
    if (this.presence.has('CHAT')) this.hub.ask('to @CHAT set Say = STOP', 'u').catch(() => {});
    this.hub.ask('to @AM-MCL set Speak = STOP', 'u').catch(() => {});
  }
  hearUser(words) {
    const now = performance.now();
    this.typed = this.typed.filter(([when]) => now - when < kSameMs);
    this.typed.push([now, words]);
    this.add('you', words);
  }
  fail(why) { this.add('note', why); }

  // ---- a dialogue that is held here (scripts/web_dialog.py): it begins with the first page, and again when it is asked to
  // A page that is opened anew shows what both have said before; where nothing was said, it greets.
  // Asked once, however often the module is heard to be there before it answers.
  recall() { this.recalling ??= this.showHistory().catch(() => {}).finally(() => { this.recalling = null; }); }
  async showHistory() {
    const empty = () => this.nodes.log.childElementCount === 0;
    if (!empty()) return;
    const history = await this.hub.ask('to @CHAT inq History');
    if (!empty()) return;
    const said = JSON.parse(history).slice(-kMostRecalled);
    for (const {role, content} of said)
      for (const words of content.split('\n')) this.add(role === 'user' ? 'you' : 'agent', words);
    if (said.length === 0) this.add('event', text('welcome'));
    if (await this.hub.ask('to @CHAT inq Busy') === 'THINKING') put(this.nodes.status, 'thinking');
  }
  startDialog(who) { this.hub.ask('to @DIALOG set Dialog = START', who).catch(error => this.fail(error.message)); }
  showDialog(state) {
    const was = this.dialog;
    this.dialog = state;
    const over = {OVER: 'dialog_over', FAILED: 'dialog_failed'}[state];
    this.nodes.again.hidden = !over;
    if (over && was !== state) this.add('event', text(over));
    this.showWay();
  }

  // ---- what the modules report
  hear({from, slot, value}) {
    if (from === 'SSM') this.hearVoice(slot, value);
    if (from === 'DIALOG' && slot === 'Dialog') this.showDialog(value);
    if (from === 'SRM' && slot === 'Listen.stat') {
      this.listening = value !== 'OFF';
      this.showWay();
    }
    if ((from === 'SRM' && slot === 'Result') || (from === 'CHAT' && slot === 'Heard')) this.hearOnce(value);
    if (from !== 'CHAT') return;
    if (slot === 'Busy') value === 'THINKING' ? put(this.nodes.status, 'thinking') : this.clearStatus();
    if (slot === 'Busy' && value === 'THINKING') this.mute = false;
    if (slot === 'Reply.sentence') {
      this.unsaid = value;
      if (this.mute || this.presence.lacks('SSM')) this.showUnsaid();
    }
    if (slot === 'Say.error') {
      this.mute = true;
      this.showUnsaid(value);
    }
    if (slot === 'Model.error') this.fail(text('model_error', {why: value}));
    if (slot === 'Listen') {
      this.chat_listens = value === 'ON';
      this.showWay();
    }
  }
  // What was typed here comes back as heard, from the ear and from the module that answers.
  hearOnce(words) {
    const now = performance.now();
    if (this.typed.some(([when, same]) => same === words && now - when < kSameMs)) return;
    this.hearUser(words);
  }
  // An answer the voice does not say can still be read; that it does not is said once while it is away.
  showUnsaid(why) {
    if (this.unsaid) this.read = {words: this.unsaid, line: this.add('agent', this.unsaid)};
    this.unsaid = '';
    if (this.presence.has('SSM')) {
      if (why) this.fail(text('voice_failed', {why}));
    } else if (!this.told_away) {
      this.told_away = true;
      this.fail(text('voice_away'));
    }
  }
  hearVoice(slot, value) {
    if (slot === 'Speak.text') this.sentence = value;
    if (slot === 'Speak.dur') this.length_ms = Number(value);
    if (slot === 'Speak.len' && this.speaking && Number(value) < this.length_ms - 1) {
      const mark = element('i');
      put(mark, 'interrupted');
      this.speaking.append(' ', mark);
    }
    if (slot !== 'Speak.stat') return;
    const sentence = value === 'SPEAKING' ? this.sentence : '';
    if (sentence && !this.speaking)
      this.speaking = this.read?.words === sentence ? this.read.line : this.add('agent', sentence);
    if (sentence) this.unsaid = '', this.read = null, this.mute = false;
    if (value === 'IDLE') this.speaking = null;
    // As late as the voice is heard.
    if (value === 'SPEAKING' || value === 'IDLE')
      setTimeout(() => { this.nodes.subtitle.textContent = sentence; }, this.delay.ms);
  }

  look() {
    this.showWay();
    this.sayHeld();
  }
  async come(name) {
    if (name === 'SSM') this.told_away = false;
    if (name === 'SRM') {
      const stat = await this.hub.ask('to @SRM inq Listen.stat').catch(() => 'OFF');
      this.listening = stat !== 'OFF';
    }
    if (name === 'DIALOG') {
      this.showDialog(await this.hub.ask('to @DIALOG inq Dialog').catch(() => ''));
      if (this.dialog === 'WAITING') this.startDialog('w');
    }
    if (name === 'CHAT') this.recall();  // not awaited: the page goes on without it
    if (name === 'CHAT') this.chat_listens = (await this.hub.ask('to @CHAT inq Listen').catch(() => 'ON')) === 'ON';
    this.showWay();
  }
  go(name) {
    if (name === 'SSM') {
      this.speaking = null;
      this.nodes.subtitle.textContent = '';
    }
    if (name === 'SRM') this.listening = false;
    if (name === 'CHAT') this.clearStatus();
    if (name === 'DIALOG') this.showDialog('');
    // One that somebody else holds.
    if (name === 'DM' && this.hub.on && !this.presence.has('DIALOG')) this.add('event', text('dialog_over'));
    this.showWay();
  }
}
