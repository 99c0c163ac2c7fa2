// Which face and voice, which language, which emotion and how strong. What was chosen here, or what a module showed
// when this page found it, is chosen again when the module comes back. An expression is shown as the face has it, whoever
// set it, except while somebody is at its pickers; one chosen here is forgotten once somebody else has set another.
import {element, put, text, useLanguage} from './texts.js';

const kEmotions = ['NEUTRAL', 'HAPPY', 'SAD', 'ANGRY', 'SURPRISED', 'DISGUSTED', 'FEARED'];
const kOwnLanguages = ['en', 'ja'];  // the page's own, which are there whatever runs
const kByScript = 'ja';              // the voice finds by itself who speaks it
const kFullStrength = 100;

function fill(select, values, now) {
  select.replaceChildren(...values.map(value => element('option', {value, textContent: value})));
  if (now && !values.includes(now)) select.append(element('option', {value: now, textContent: now}));
  select.value = now;
  select.disabled = values.length === 0;
}

// "en ja" as a list; null where any language is meant, or none is told.
// The language's name in itself; the code where it is none, as any module may tell anything.
function nameOf(code) {
  try {
    return new Intl.DisplayNames([code], {type: 'language'}).of(code) ?? code;
  } catch {
    return code;
  }
}
const codesOf = words => words === '*' || words === '' ? null : words.split(/\s+/);

export class Pickers {
  // `nodes`: face, voice, language, emotion (select), strength (range), strength_value, and canvas, which is named after them.
  constructor(hub, presence, nodes, onError) {
    Object.assign(this, {hub, presence, nodes, onError});
    this.chosen = JSON.parse(sessionStorage.getItem('chosen') || '{}');
    this.shown = {};  // face and voice as they are, as long as the hub is the same
    const emotions = kEmotions.map(value => {
      const option = element('option', {value});
      put(option, value);
      return option;
    });
    nodes.emotion.replaceChildren(...emotions);
    this.speakers = new Map();    // of each language of the voice
    this.answers = kOwnLanguages; // the languages of the module that answers; null: any
    this.understood = null;       // those of the ear; null: any
    this.percent = kFullStrength; // the strength, also where the range has no such step
    this.heard = '';              // the expression the face has told of while somebody was at the pickers
    this.showExpression(this.chosen.expression ?? 'NEUTRAL');
    useLanguage(this.chosen.language || 'AUTO');
    this.showLanguages();
    for (const [what, node] of [['face', nodes.face], ['voice', nodes.voice], ['language', nodes.language],
                                ['emotion', nodes.emotion], ['strength', nodes.strength]]) {
      node.onchange = () => this.choose(what, node.value);
    }
    nodes.strength.oninput = () => {
      this.percent = nodes.strength.value;
      this.show();
    };
    for (const node of [nodes.emotion, nodes.strength]) node.onblur = () => this.showHeard();
    for (const node of [nodes.face, nodes.voice]) fill(node, [], '');
    this.show();
  }

  // Those that are both answered in and spoken; which of them the ear does not understand is said.
  showLanguages() {
    const {language} = this.nodes, now = this.chosen.language || 'AUTO';
    const spoken = [...this.speakers.keys()];
    const codes = spoken.length === 0 ? kOwnLanguages : this.answers ? this.answers.filter(code => spoken.includes(code)) : spoken;
    const options = [...new Set(['AUTO', ...codes, now])].map(value => element('option', {value}));
    language.replaceChildren(...options);
    language.value = now;
    this.nameLanguages();
  }
  nameLanguages() {
    for (const option of this.nodes.language.options) {
      const {value} = option;
      if (value === 'AUTO') {
        put(option, 'automatic');
        continue;
      }
      const name = nameOf(value);
      const heard = !this.understood || this.understood.includes(value);
      option.textContent = heard ? name : text('typed_only', {language: name});
    }
  }
  // Latin letters are read in the speaker's own language, so that has to be the one chosen.
  async speakIn(language) {
    const names = this.speakers.get(language);
    if (!names || language === kByScript || names.includes(this.nodes.voice.value)) return;
    this.nodes.voice.value = names[0];
    this.choose('voice', names[0]);
  }

  choose(what, value) {
    if (what === 'strength') this.percent = value;
    if (what === 'emotion' || what === 'strength') {
      const name = this.nodes.emotion.value;
      this.chosen.expression = name === 'NEUTRAL' ? name : `${name} 1 ${this.percent} 0`;
      this.heard = '';
    } else {
      this.chosen[what] = value;
    }
    this.keep();
    if (what === 'language') useLanguage(value), this.nameLanguages();
    this.show();
    this.set(what === 'strength' ? 'emotion' : what);
    if (what === 'language') this.speakIn(value);
  }
  keep() { sessionStorage.setItem('chosen', JSON.stringify(this.chosen)); }
  show() {
    const {strength, strength_value, emotion, canvas, face} = this.nodes;
    strength_value.textContent = `${this.percent} %`;
    strength.disabled = emotion.value === 'NEUTRAL';
    canvas.setAttribute('aria-label', [text('face'), face.value, text(emotion.value)].filter(Boolean).join(', '));
  }
  set(what) {
    const {chosen, nodes} = this;
    const emotion = nodes.emotion.value === 'NEUTRAL' ? 'NEUTRAL' : `${nodes.emotion.value} ${this.percent}`;
    const [module, line] = {
      face: ['FSM', `set Mask = ${nodes.face.value}`],
      voice: ['SSM', `set Speaker = ${nodes.voice.value}`],
      language: ['CHAT', `set Language = ${chosen.language}`],
      emotion: ['AM-MCL', `set Emotion = ${emotion}`],
    }[what];
    if (module !== 'AM-MCL' && !this.presence.has(module)) return Promise.resolve();
    return this.hub.ask(`to @${module} ${line}`, 'u').catch(error => this.onError(error.message));
  }

  async come(name) {
    const list = async line => (await this.hub.ask(line).catch(() => '')).replace(/"/g, '');
    // What there is to choose from, and the way to ask which of them it is.
    const restore = async (what, values, question) => {
      const node = this.nodes[what], now = await list(question), wanted = this.chosen[what] ?? this.shown[what];
      const others = wanted !== now && values.includes(wanted);
      fill(node, values, others ? wanted : now);
      if (others) {
        await this.set(what);
        fill(node, values, await list(question));
      }
      this.shown[what] = node.value;
    };
    if (name === 'FSM') {
      const faces = (await list('to @FSM inq MaskSet')).split(',').map(face => face.trim()).filter(Boolean);
      await restore('face', faces, 'to @FSM inq NowMask');
      await list('to @FSM prop FaceExp = AutoOutput');  // by itself the face does not tell when somebody sets it
      if (this.chosen.expression) await this.set('emotion');
      else this.followExpression(await list('to @FSM inq FaceExp'));
    }
    if (name === 'SSM') {
      const voices = (await list('to @SSM inq Speaker.all')).split(/\s+/).filter(Boolean);
      await restore('voice', voices, 'to @SSM inq Speaker');
    }
    if (name === 'CHAT' && this.chosen.language) await this.set('language');
    this.learnLanguages(name, list);  // not awaited: the page goes on without them
    this.show();
  }
  async learnLanguages(name, list) {
    const question = {SSM: 'Speaker.languages', SRM: 'Listen.languages', CHAT: 'Language.all'}[name];
    if (!question) return;
    const words = await list(`to @${name} inq ${question}`);
    if (name === 'SSM') {
      const languages = words.split(';').map(part => part.trim().split(/\s+/)).filter(([code]) => code);
      this.speakers = new Map(languages.map(([code, ...names]) => [code, names]));
    }
    if (name === 'SRM') this.understood = codesOf(words);
    if (name === 'CHAT') this.answers = codesOf(words);
    this.showLanguages();
  }
  // "ANGRY 1 60 2000": its name, pattern, strength and the ms after which it ends; what is left out is as at the face.
  showExpression(words) {
    const [name, , strength = kFullStrength] = words.split(/\s+/), {emotion} = this.nodes;
    if (![...emotion.options].some(option => option.value === name)) {
      this.other?.remove();  // one at a time, however many names a face may tell
      this.other = emotion.appendChild(element('option', {value: name, textContent: name}));
    }
    emotion.value = name;
    if (name !== 'NEUTRAL') this.nodes.strength.value = this.percent = strength;
    this.show();
  }
  followExpression(words) {
    if (!words) return;
    clearTimeout(this.ending);
    const ms = Number(words.split(/\s+/)[3]);
    if (ms > 0) this.ending = setTimeout(() => this.followExpression('NEUTRAL'), ms);
    this.heard = words;
    if (![this.nodes.emotion, this.nodes.strength].includes(document.activeElement)) this.showHeard();
  }
  showHeard() {
    const words = this.heard;
    if (!words) return;
    this.heard = '';
    if (words !== this.chosen.expression) {
      delete this.chosen.expression;
      this.keep();
    }
    this.showExpression(words);
  }
  // The hub has gone; one that is started anew may have another face.
  leave() { this.shown = {}; }
  go(name) {
    if (name === 'FSM') this.nodes.face.disabled = true;
    if (name === 'SSM') this.nodes.voice.disabled = true;
  }
  // Somebody else has chosen.
  hear({from, slot, value}) {
    if (from === 'FSM' && slot === 'FaceExp') this.followExpression(value);
    if (from === 'SSM' && slot === 'Speaker' && !this.nodes.voice.disabled) this.shown.voice = this.nodes.voice.value = value;
  }
}
