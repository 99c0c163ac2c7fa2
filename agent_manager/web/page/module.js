// A module is whoever says `rep Run = LIVE` under a name and answers to its slots: Listen hands the
// browser's microphone to the ear, Result reports what the ear has understood.
import {Galatea} from './galatea.js';
import {Microphone} from './microphone.js';

const hub = new Galatea();
const $ = id => document.getElementById(id);
const slots = {Run: 'LIVE', Listen: 'OFF', Result: ''};
const began = performance.now();

function report(slot, value) {
  slots[slot] = value;
  hub.send(`rep ${slot} = ${value}`);
}
function say(text) { $('said').textContent = text; }

const microphone = new Microphone(why => {
  report('Listen', 'OFF');
  say(why || 'Not listening.');
});
async function listen(on) {
  if (on === microphone.on) return;
  if (!on) return microphone.stop();
  await microphone.start();
  await hub.ask('to @SRM set Listen = START').catch(error => { microphone.stop(); throw error; });
  report('Listen', 'ON');
  say('Listening: say something.');
}

hub.onReport = ({from, slot, value}) => {
  if (from !== 'SRM' || !microphone.on) return;
  if (slot === 'Result.partial') say(`${value} ...`);
  if (slot === 'NoMatch') say(`not understood: ${value}`);
  if (slot !== 'Result') return;
  say(value);
  report('Result', value);
};
hub.onCommand = ({command, tag, slot, value}) => {
  $('flow').append(`${command} ${slot} ${value}\n`);
  const answer = (name, text) => { if (tag) hub.send(`rep#${tag} ${name} = ${text}`); };
  if (slot === 'Slots') return answer('Slots', Object.keys(slots).join(' '));
  if (slot === 'Clock' && command === 'inq') return answer('Clock', (performance.now() - began).toFixed(3));
  if (slot === 'Listen' && command === 'set') {
    return listen(value === 'ON').then(() => answer('Listen', slots.Listen),
                                       error => answer('Listen.error', `UNAVAILABLE ${error.message}`));
  }
  if (command === 'inq' && slot in slots) return answer(slot, slots[slot]);
  if (command === 'prop') return answer(slot, value);
  answer(`${slot}.error`, `UNKNOWN_SLOT found '${slot}', expected Listen or Result`);
};
hub.onState = on => {
  $('link').textContent = on ? 'connected' : 'the hub is away';
  $('link').className = `state ${on ? 'on' : 'off'}`;
  if (!on) return;
  hub.ask('to @AM set Name = PAGE').then(() => {
    hub.send('set Subscribe = SRM');
    hub.send('rep Run = LIVE');
  }, error => say(error.message));
};
$('listen').onclick = () => listen(!microphone.on).catch(error => say(error.message));
