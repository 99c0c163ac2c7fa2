// The hub's page: the face, the modules and their slots, the messages, the timing of what was said.
'use strict';

const $ = id => document.getElementById(id);
const hub = new Galatea();
const kLooks = ['NEUTRAL', 'HAPPY', 'SAD', 'ANGRY', 'SURPRISED', 'DISGUSTED', 'FEARED'];
const kMostLines = 500, kMostUtterances = 6;

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  Object.assign(made, attributes);
  made.append(...children);
  return made;
}

function show(text, bad = false) {
  $('answer').textContent = text;
  $('answer').className = bad ? 'bad' : '';
}

function ask(line) {
  return hub.ask(line, 'u').then(value => { show(value); return value; },
                            error => { show(error.message, true); throw error; });
}

// ---- the face
function watchFace() {
  $('face').onload = () => $('face').classList.add('on');
  $('face').onerror = () => {
    $('face').classList.remove('on');
    setTimeout(watchFace, 3000);
  };
  $('face').src = `face.mjpg?${Date.now()}`;
}

// ---- speech and commands
$('speak').onsubmit = event => {
  event.preventDefault();
  const text = $('text').value.trim();
  if (!text) return;
  const is_line = /^(to\s+@|(set|inq|prop|save|rest|del|def|do)\s)/i.test(text);
  ask(is_line ? text : `to @AM-MCL set Speak = ${text}`).catch(() => {});
  $('text').select();
};
$('hush').onclick = () => ask('to @AM-MCL set Speak = STOP').catch(() => {});

// ---- the microphone: what the ear understands is shown as an answer
const microphone = new Microphone(why => {
  $('talk').textContent = 'Talk';
  show(why, Boolean(why));
});
$('talk').onclick = async () => {
  if (microphone.on) return microphone.stop();
  try {
    await microphone.start();
    await hub.ask('to @SRM set Listen = START', 'u');
    $('talk').textContent = 'Talk no more';
    show('listening: say something');
  } catch (error) {
    microphone.stop();
    show(error.message, true);
  }
};
function hearEar(slot, value) {
  if (slot === 'Result.partial') show(`${value} ...`);
  if (slot === 'Result') show(`heard: ${value}`);
  if (slot === 'NoMatch') show(`not understood: ${value}`, true);
}

for (const look of kLooks) {
  $('looks').append(element('button', {
    textContent: look.toLowerCase(),
    onclick: () => ask(`to @FSM set FaceExp = ${look} 1 100 0`).catch(() => {}),
  }));
}

// ---- modules
const pids = new Map();
const opened = new Set();  // modules whose last lines are being read
function whyOf(name, ending, log) {
  if (!ending && !log) return [];
  const lines = log.split(' | ').map(line => element('div', {className: line.split(' ')[0], textContent: line}));
  const details = element('details', {open: opened.has(name)},
      element('summary', {className: ending ? 'why' : '', textContent: ending ? `ended before: ${ending}` : 'what it has said'}),
      ...lines);
  details.ontoggle = () => { details.open ? opened.add(name) : opened.delete(name); };
  return [element('tr', {className: 'said'}, element('td', {colSpan: 4}, details))];
}
async function showModules() {
  const text = await hub.ask('inq Processes').catch(() => '');
  const rows = [];
  for (const part of text.split(', ').filter(Boolean)) {
    const name = part.split(' ')[0];
    const of = slot => hub.ask(`inq Module.${name}.${slot}`).catch(() => '');
    const [state, pid, starts, ending, log] =
        await Promise.all(['state', 'pid', 'starts', 'ending', 'log'].map(of));
    const act = word => element('button', {
      textContent: word,
      onclick: () => ask(`set ${word} = ${name}`).catch(() => {}).then(showModules),
    });
    if (state === 'READY' && pid !== pids.get(name)) {  // it has come, perhaps anew
      pids.set(name, pid);
      if (name === 'FSM') watchFace();
      if (name === $('whose').value) showSlots();
    }
    rows.push(element('tr', {},
        element('td', {}, element('b', {textContent: name})),
        element('td', {className: state, textContent: state}),
        element('td', {textContent: pid > 0 ? `pid ${pid}, start ${starts}` : ''}),
        element('td', {}, act('Start'), act('Stop'), act('Restart'))), ...whyOf(name, ending, log));
  }
  $('modules').tBodies[0].replaceChildren(...rows);
  showNames();
}

async function showNames() {
  const names = (await hub.ask('inq Modules').catch(() => '')).split(' ').filter(Boolean);
  const all = ['AM', 'AM-MCL', ...names];
  const now = [...$('whose').options].map(option => option.value);
  if (now.join() === all.join()) return;
  const chosen = $('whose').value;
  $('whose').replaceChildren(...all.map(name => element('option', {value: name, textContent: name})));
  $('whose').value = all.includes(chosen) ? chosen : (all.includes('FSM') ? 'FSM' : 'AM');
  if ($('whose').value !== chosen) showSlots();
}

// ---- slots
let showing = 0;
async function showSlots() {
  const mine = ++showing;
  const whose = $('whose').value;
  const names = (await hub.ask(`to @${whose} inq Slots`).catch(() => '')).split(/[ ,]+/).filter(Boolean);
  if (mine !== showing) return;
  $('slots').tBodies[0].replaceChildren(...names.map(name => {
    const value = element('input', {value: '', ariaLabel: name});
    const row = element('tr', {}, element('td', {textContent: name}), element('td', {}, value));
    row.dataset.name = name;
    value.onfocus = () => hub.ask(`to @${whose} inq ${name}.help`)
        .then(help => { row.title = help; show(`${name}: ${help}`); }, () => {});
    value.onchange = () => ask(`to @${whose} set ${name} = ${value.value}`).then(
        () => hub.ask(`to @${whose} inq ${name}`)).then(now => { value.value = now; }, () => {});
    hub.ask(`to @${whose} inq ${name}.prop`).then(attributes => {
      value.readOnly = attributes.includes('ReadOnly');
      if (attributes.includes('WriteOnly')) value.placeholder = 'can only be set';
      else hub.ask(`to @${whose} inq ${name}`).then(now => { value.value = now; }, () => {});
    }, () => {});
    return row;
  }));
  filterSlots();
}
function filterSlots() {
  const wanted = $('slot-filter').value.toLowerCase();
  for (const row of $('slots').rows) row.hidden = !row.dataset.name.toLowerCase().includes(wanted);
}
$('whose').onchange = showSlots;
$('slot-filter').oninput = filterSlots;

// A value that is reported while its slot is shown is shown anew, unless somebody is writing there.
function updateSlot(from, line) {
  const found = from === $('whose').value && line.match(/^(?:From @\S+ )?rep(?:#\S+)? (\S+) = (.*)$/);
  if (!found) return;
  for (const row of $('slots').rows) {
    const value = row.querySelector('input');
    if (row.dataset.name === found[1] && value !== document.activeElement) value.value = found[2];
  }
}

// ---- messages
const lines = [];
function lineOf(entry) {
  const row = element('div', {className: /\.error = /.test(entry.line) ? 'error' : ''},
      `${entry.time.toFixed(1).padStart(10)}  `,
      element('b', {textContent: `${entry.from} > ${entry.to}`}), `  ${entry.line}`);
  return row;
}
const passes = entry => `${entry.from} ${entry.to} ${entry.line}`.toLowerCase()
    .includes($('flow-filter').value.toLowerCase());
function showFlow() {
  $('flow').replaceChildren(...lines.filter(passes).map(lineOf));
  $('flow').scrollTop = $('flow').scrollHeight;
}
$('flow-filter').oninput = showFlow;
// What this page asks by itself would fill the list.
const ours = entry => /^(?:(?:to|From) \S+ )*[a-z]+#w\d/.test(entry.line);
hub.onFlow = entry => {
  measure(entry);
  updateSlot(entry.from, entry.line);
  if (/ (Run|Module\.|Processes|Modules)\b.*/.test(entry.line) && entry.line.startsWith('tell')) showModules();
  if ($('hold').checked || ours(entry)) return;
  lines.push(entry);
  if (lines.length > kMostLines) lines.shift();
  if (!passes(entry)) return;
  const at_end = $('flow').scrollHeight - $('flow').scrollTop - $('flow').clientHeight < 40;
  $('flow').append(lineOf(entry));
  while ($('flow').childElementCount > kMostLines) $('flow').firstChild.remove();
  if (at_end) $('flow').scrollTop = $('flow').scrollHeight;
};

// ---- timing: when the text went to the voice, its phonemes came, the sound and the face began and ended
const utterances = [];
function measure({time, from, to, line}) {
  let found;
  const now = utterances[utterances.length - 1];
  if (to === 'SSM' && (found = line.match(/set(?:#\S+)? Text = (.*)/))) {
    utterances.push({words: found[1], text: time});
    if (utterances.length > kMostUtterances) utterances.shift();
  } else if (now && from === 'SSM' && /rep(?:#\S+)? Text\.pho/.test(line)) {
    now.phonemes ??= time;
  } else if (now && from === 'SSM' && /rep(?:#\S+)? Speak\.stat = SPEAKING/.test(line)) {
    now.sound ??= time;
  } else if (now && from === 'SSM' && /rep(?:#\S+)? Speak\.stat = IDLE/.test(line) && now.sound) {
    now.silent ??= time;
  } else if (now && from === 'FSM' && /rep(?:#\S+)? Speak\.stat = SPEAKING/.test(line)) {
    now.frames ??= time;
  } else if (now && from === 'FSM' && /rep(?:#\S+)? Speak\.stat = IDLE/.test(line) && now.frames) {
    now.still ??= time;
  } else {
    return;
  }
  draw();
}
function draw() {
  const width = $('chart').clientWidth || 600, row = 24, left = 130;
  const longest = Math.max(500, ...utterances.map(
      u => Math.max(...['phonemes', 'sound', 'silent', 'frames', 'still'].map(k => u[k] || u.text)) - u.text));
  const x = ms => left + ms / longest * (width - left - 60);
  const parts = [];
  const bar = (u, a, b, kind, y, high) => {
    if (u[a] === undefined || u[b] === undefined) return;
    const from = u[a] - u.text, till = u[b] - u.text;
    parts.push(`<rect class="bar-${kind}" x="${x(from)}" y="${y}" height="${high}" ` +
               `width="${Math.max(1, x(till) - x(from))}"><title>${kind}: ${from.toFixed(1)} to ` +
               `${till.toFixed(1)} ms</title></rect>`);
  };
  utterances.forEach((u, i) => {
    const y = 6 + i * row;
    const words = u.words.length > 18 ? u.words.slice(0, 17) + '…' : u.words;
    parts.push(`<text x="4" y="${y + 12}">${words.replace(/[<&]/g, '')}</text>`);
    bar(u, 'text', 'phonemes', 'text', y, 16);
    bar(u, 'phonemes', 'sound', 'wait', y, 16);
    bar(u, 'sound', 'silent', 'sound', y, 8);
    bar(u, 'frames', 'still', 'frames', y + 8, 8);
    const end = Math.max(u.silent || 0, u.still || 0);
    if (end) parts.push(`<text x="${x(end - u.text) + 4}" y="${y + 12}">${Math.round(end - u.text)} ms</text>`);
  });
  if (!parts.length) parts.push(`<text x="8" y="20">Let it say something, and here is how it went.</text>`);
  $('chart').innerHTML = parts.join('');
}
draw();

hub.onState = on => {
  $('link').textContent = on ? 'connected' : 'the hub is away';
  $('link').className = `state ${on ? 'on' : 'off'}`;
  if (!on) return;
  hub.send('set Subscribe = *');
  hub.send('set Flow = ON');
  showModules();
};
hub.onReport = ({from, slot, value}) => {
  if (from === 'SRM' && microphone.on) hearEar(slot, value);
  // A module has come, gone, or said something for people.
  if ((slot === 'Run' && value === 'LIVE') || /has gone/.test(value) || slot.startsWith('Module.')) showModules();
};
setInterval(showModules, 3000);
