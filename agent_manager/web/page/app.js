// The hub's page: a conversation with the agent, and the engineer's view of it.
import {Conversation} from './conversation.js';
import {Engineer} from './engineer.js';
import {Galatea, Refusal} from './galatea.js';
import {Listening} from './listening.js';
import {Pickers} from './pickers.js';
import {Delay, FacePlayer, SessionClock, VoicePlayer} from './playback.js';
import {Presence} from './presence.js';
import {put, text} from './texts.js';

const $ = id => document.getElementById(id);
const kMeasureEveryMs = 5000;

const hub = new Galatea();
const presence = new Presence(hub);
const clock = new SessionClock(hub);
const delay = new Delay();

// ---- face and voice
// What a refusal means to somebody who talks; null: nothing is known.
function told(why, module) {
  if (why == null) return text('unknown_why');
  const {code, words} = new Refusal(why);
  const away = code === 'UNKNOWN_MODULE' || (code === 'UNAVAILABLE' && !presence.has(module));
  return away ? text('module_away') : words;
}
const face = new FacePlayer($('face'), clock, delay, why => {
  $('stage').classList.toggle('off', why !== '');
  if (why !== '') put($('face-off'), 'no_face', {why: told(why, 'FSM')});
});
let lost_voice = '', sink = 'null', loud = true;
const voice = new VoicePlayer(clock, delay, why => {
  lost_voice = why;
  showSound();
});
function showSound() {
  const on = voice.allowed && loud;
  $('sound').setAttribute('aria-pressed', String(on));
  put($('sound'), on ? 'sound_off' : 'sound_on');
  const state = $('sound-state');
  if (sink !== 'null' && !loud) put(state, 'sound_twice', {sink});
  else if (!voice.allowed) put(state, 'sound_blocked');
  else if (lost_voice !== '') put(state, 'no_voice', {why: told(lost_voice, 'SSM')});
  else state.replaceChildren(), delete state.dataset.text;
}
voice.context.onstatechange = showSound;
$('sound').onclick = () => {
  loud = !(voice.allowed && loud);
  voice.loud = loud;
  voice.allow();
  showSound();
};
$('subtitles').onclick = () => {
  const on = $('subtitle').hidden;
  $('subtitle').hidden = !on;
  $('subtitles').setAttribute('aria-pressed', String(on));
};
$('full').onclick = () => $('stage').requestFullscreen().catch(() => {});
// Where there is little room the pickers fold, so that log and buttons stay in view; also when the room becomes less.
const narrow = matchMedia('(max-width: 900px)');
narrow.onchange = () => { $('settings').open = !narrow.matches; };
narrow.onchange();

// ---- the parts
const pickers = new Pickers(hub, presence, {
  face: $('pick-face'), voice: $('pick-voice'), language: $('pick-language'), emotion: $('pick-emotion'),
  strength: $('pick-strength'), strength_value: $('strength'), canvas: $('face'),
}, why => conversation.fail(why));
const conversation = new Conversation(hub, presence, {
  log: $('log'), subtitle: $('subtitle'), status: $('status'), form: $('speak'), input: $('text'), stop: $('hush'), way: $('way'), again: $('again'),
}, {voice, delay});
const listening = new Listening(hub, presence, {button: $('microphone'), state: $('microphone-state')});
const engineer = new Engineer(hub);
const parts = [conversation, listening, pickers, engineer];

async function askSink() {
  sink = await hub.ask('to @SSM inq Sink').catch(() => 'null');
  loud = sink === 'null';
  voice.loud = loud;
  showSound();
}
presence.onCome = name => {
  if (name === 'SSM') askSink();
  return Promise.all(parts.map(part => part.come(name)));
};
presence.onLook = () => conversation.look();
presence.onGo = name => { for (const part of parts) part.go(name); };
hub.onReport = report => {
  presence.hear(report);
  for (const part of parts) part.hear(report);
};
hub.onFlow = entry => engineer.flow(entry);

// ---- the connection
hub.onState = async on => {
  put($('link'), on ? 'connected' : 'away');
  $('link').className = `state ${on ? 'on' : 'off'}`;
  if (!on) {
    presence.leave();
    return pickers.leave();
  }
  hub.send('set Subscribe = *');
  engineer.connect();
  await clock.start();
  presence.look();
};
hub.onRefused = status => { if (status === 401) put($('link'), 'refused'); };
setInterval(() => { if (hub.on && clock.known) clock.measure(); }, kMeasureEveryMs);

// ---- tabs: arrow keys go from one to the other
const tabs = [...$('tabs').children];
function choose(tab) {
  for (const each of tabs) {
    const chosen = each === tab;
    each.setAttribute('aria-selected', String(chosen));
    each.tabIndex = chosen ? 0 : -1;
    $(each.getAttribute('aria-controls')).hidden = !chosen;
  }
  engineer.show(tab.id === 'engineer-tab');
}
for (const tab of tabs) tab.onclick = () => choose(tab);
$('tabs').onkeydown = event => {
  const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
  if (!step) return;
  const next = tabs[(tabs.indexOf(document.activeElement) + step + tabs.length) % tabs.length];
  choose(next);
  next.focus();
};
showSound();

// For those who measure or look into the page from the browser's console.
window.galatea = {hub, clock, delay, face, voice};
