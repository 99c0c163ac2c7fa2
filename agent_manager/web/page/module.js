'use strict';
// A module is whoever says `rep Run = LIVE` under a name and answers to its slots: Listen takes
// speech from the browser's microphone where there is one, Result reports what was heard.
const hub = new Galatea();
const $ = id => document.getElementById(id);
const slots = {Run: 'LIVE', Listen: 'OFF', Result: ''};
const began = performance.now();
const Recognition = window.SpeechRecognition || window.webkitSpeechRecognition;
let recognition = null;

function report(slot, value) {
  slots[slot] = value;
  hub.send(`rep ${slot} = ${value}`);
}
function listen(on) {
  if (!on) {
    if (recognition) recognition.stop();
    recognition = null;
    report('Listen', 'OFF');
    return '';
  }
  if (!Recognition) return 'UNAVAILABLE this browser recognises no speech';
  recognition = new Recognition();
  recognition.continuous = true;
  recognition.onresult = event => {
    const text = event.results[event.results.length - 1][0].transcript.trim();
    $('said').textContent = text;
    report('Result', text);
  };
  recognition.onerror = event => { $('said').textContent = event.error; listen(false); };
  recognition.start();
  report('Listen', 'ON');
  return '';
}
hub.onCommand = ({command, tag, slot, value}) => {
  $('flow').append(`${command} ${slot} ${value}\n`);
  const answer = (name, text) => { if (tag) hub.send(`rep#${tag} ${name} = ${text}`); };
  if (slot === 'Slots') return answer('Slots', Object.keys(slots).join(' '));
  if (slot === 'Clock' && command === 'inq') return answer('Clock', (performance.now() - began).toFixed(3));
  if (slot === 'Listen' && command === 'set') {
    const refused = listen(value === 'ON');
    return refused ? answer('Listen.error', refused) : answer('Listen', value);
  }
  if (command === 'inq' && slot in slots) return answer(slot, slots[slot]);
  if (command === 'prop') return answer(slot, value);
  answer(`${slot}.error`, `UNKNOWN_SLOT found '${slot}', expected Listen or Result`);
};
hub.onState = on => {
  $('link').textContent = on ? 'connected' : 'the hub is away';
  $('link').className = `state ${on ? 'on' : 'off'}`;
  if (!on) return;
  hub.ask('to @AM set Name = PAGE').then(() => hub.send('rep Run = LIVE'),
                                         error => { $('said').textContent = error.message; });
};
$('listen').onclick = () => {
  const refused = listen(slots.Listen === 'OFF');
  if (refused) $('said').textContent = refused;
};
