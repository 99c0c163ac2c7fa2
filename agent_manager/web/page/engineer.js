// The engineer's view: the modules, their slots, every message, the timing of what was said.
import {groupOf, kGroups, kOther} from './slot_groups.js';
import {element} from './texts.js';
import {Timing} from './timing.js';

const kMostLines = 500;
const kLookEveryMs = 3000;
const $ = id => document.getElementById(id);

// What a page asks by itself would fill the list of messages.
const isOurs = entry => /^(?:(?:to|From) \S+ )*[a-z]+#w\d/.test(entry.line);

export class Engineer {
  constructor(hub) {
    this.hub = hub;
    this.timing = new Timing($('chart'));
    this.lines = [];
    this.pids = new Map();
    this.opened = new Set();  // modules whose last lines are being read
    this.showing = 0;
    this.shown = false;
    $('line-form').onsubmit = event => {
      event.preventDefault();
      this.ask($('line').value).catch(() => {});
      $('line').select();
    };
    $('whose').onchange = () => this.showSlots();
    $('slot-filter').oninput = () => this.filterSlots();
    $('flow-filter').oninput = () => this.showFlow();
    setInterval(() => this.showModules(), kLookEveryMs);
  }

  connect() {
    this.hub.send('set Flow = ON');
    this.showModules();
  }
  show(shown) {
    this.shown = shown;
    if (!shown) return;
    this.showModules();
    this.showFlow();
    this.timing.draw();
  }
  come(name) {
    this.showModules();
    if (this.shown && name === $('whose').value) this.showSlots();
  }
  go() { this.showModules(); }
  hear({slot}) { if (slot.startsWith('Module.')) this.showModules(); }

  answer(text, bad = false) {
    $('answer').textContent = text;
    $('answer').className = bad ? 'bad' : '';
  }
  ask(line) {
    return this.hub.ask(line, 'u').then(value => { this.answer(value); return value; },
                                        error => { this.answer(error.message, true); throw error; });
  }

  // ---- modules
  async showModules() {
    if (!this.shown) return;
    const text = await this.hub.ask('inq Processes').catch(() => '');
    const rows = await Promise.all(text.split(', ').filter(Boolean).map(part => this.rowsOf(part.split(' ')[0])));
    const focused = document.activeElement?.ariaLabel;
    $('modules').tBodies[0].replaceChildren(...rows.flat());
    if (focused && document.activeElement === document.body)
      [...$('modules').querySelectorAll('button')].find(button => button.ariaLabel === focused)?.focus();
    this.showNames();
  }
  async rowsOf(name) {
    const of = slot => this.hub.ask(`inq Module.${name}.${slot}`).catch(() => '');
    const [state, pid, starts, ending, failed, log] = await Promise.all(['state', 'pid', 'starts', 'ending', 'failed', 'log'].map(of));
    const act = word => element('button', {
      textContent: word, ariaLabel: `${word} ${name}`,
      onclick: () => this.ask(`set ${word} = ${name}`).catch(() => {}).then(() => this.showModules()),
    });
    if (state === 'READY' && pid !== this.pids.get(name)) {  // it has come, perhaps anew
      this.pids.set(name, pid);
      if (name === $('whose').value) this.showSlots();
    }
    return [element('tr', {},
        element('th', {scope: 'row', textContent: name}),
        element('td', {className: state, textContent: state}),
        element('td', {textContent: pid > 0 ? `pid ${pid}, start ${starts}` : ''}),
        element('td', {}, act('Start'), ' ', act('Stop'), ' ', act('Restart'))), ...this.whyOf(name, ending, failed === 'YES', log)];
  }
  whyOf(name, ending, failed, log) {
    if (!ending && !log) return [];
    const lines = log.split(' | ').map(line => element('div', {className: line.split(' ')[0], textContent: line}));
    const details = element('details', {open: this.opened.has(name)},
        element('summary', {className: failed ? 'why' : '',
                            textContent: ending ? `${name} ended before: ${ending}` : `what ${name} has said`}), ...lines);
    details.ontoggle = () => { details.open ? this.opened.add(name) : this.opened.delete(name); };
    return [element('tr', {className: 'said'}, element('td', {colSpan: 4}, details))];
  }
  async showNames() {
    const names = (await this.hub.ask('inq Modules').catch(() => '')).split(' ').filter(Boolean);
    const all = ['AM', 'AM-MCL', ...names];
    const now = [...$('whose').options].map(option => option.value);
    if (now.join() === all.join()) return;
    const chosen = $('whose').value;
    $('whose').replaceChildren(...all.map(name => element('option', {value: name, textContent: name})));
    $('whose').value = all.includes(chosen) ? chosen : (all.includes('FSM') ? 'FSM' : 'AM');
    if ($('whose').value !== chosen) this.showSlots();
  }

  // ---- slots: in groups, whose values are asked for when they are opened
  async showSlots() {
    const mine = ++this.showing;
    const whose = $('whose').value;
    const names = (await this.hub.ask(`to @${whose} inq Slots`).catch(() => '')).split(/[ ,]+/).filter(Boolean);
    if (mine !== this.showing) return;
    const groups = [...kGroups.map(([group]) => group), kOther].map(group => [group, names.filter(name => groupOf(name) === group)]);
    $('slots').replaceChildren(...groups.filter(([, slots]) => slots.length).map(([group, slots]) => {
      const rows = slots.map(name => this.slotRow(whose, name));
      const details = element('details', {}, element('summary', {textContent: `${group} (${slots.length})`}),
                              element('table', {}, element('tbody', {}, ...rows)));
      details.ontoggle = () => { if (details.open) for (const row of rows) if (!row.hidden) row.ask(); };
      return details;
    }));
    this.filterSlots();
  }
  slotRow(whose, name) {
    const value = element('input', {value: '', ariaLabel: name});
    const row = element('tr', {}, element('td', {textContent: name}), element('td', {}, value));
    const read = () => this.hub.ask(`to @${whose} inq ${name}`).then(now => { value.value = now; }, () => {});
    row.dataset.name = name;
    let asked = false;
    row.ask = async () => {
      if (asked) return;
      asked = true;
      const attributes = await this.hub.ask(`to @${whose} inq ${name}.prop`).catch(() => '');
      value.readOnly = attributes.includes('ReadOnly');
      if (attributes.includes('WriteOnly')) value.placeholder = 'can only be set';
      else read();
    };
    value.onfocus = () => this.hub.ask(`to @${whose} inq ${name}.help`)
        .then(help => { row.title = help; this.answer(`${name}: ${help}`); }, () => {});
    value.onchange = () => this.ask(`to @${whose} set ${name} = ${value.value}`).then(read, () => {});
    return row;
  }
  // While there is a filter, the groups that have such slots are open, and no others are shown.
  filterSlots() {
    const wanted = $('slot-filter').value.toLowerCase();
    for (const group of $('slots').children) {
      const rows = [...group.querySelectorAll('tr')];
      for (const row of rows) row.hidden = !row.dataset.name.toLowerCase().includes(wanted);
      const found = rows.filter(row => !row.hidden);
      group.hidden = found.length === 0;
      if (wanted) group.open = found.length > 0;
      if (group.open) for (const row of found) row.ask();
    }
  }
  // A value that is reported while its slot is shown is shown anew, unless somebody is writing there.
  updateSlot(from, line) {
    const found = from === $('whose').value && line.match(/^(?:From @\S+ )?rep(?:#\S+)? (\S+) = (.*)$/);
    if (!found) return;
    for (const row of $('slots').querySelectorAll('tr')) {
      const value = row.querySelector('input');
      if (row.dataset.name === found[1] && value !== document.activeElement) value.value = found[2];
    }
  }

  // ---- messages
  flow(entry) {
    this.timing.measure(entry);
    if (this.shown) this.updateSlot(entry.from, entry.line);
    if ($('hold').checked || isOurs(entry)) return;
    this.lines.push(entry);
    if (this.lines.length > kMostLines) this.lines.shift();
    if (!this.shown || !this.passes(entry)) return;
    const flow = $('flow');
    const at_end = flow.scrollHeight - flow.scrollTop - flow.clientHeight < 40;
    flow.append(this.lineOf(entry));
    while (flow.childElementCount > kMostLines) flow.firstChild.remove();
    if (at_end) flow.scrollTop = flow.scrollHeight;
  }
  lineOf(entry) {
    return element('div', {className: /\.error = /.test(entry.line) ? 'error' : ''},
        `${entry.time.toFixed(1).padStart(10)}  `,
        element('b', {textContent: `${entry.from} > ${entry.to}`}), `  ${entry.line}`);
  }
  passes(entry) {
    return `${entry.from} ${entry.to} ${entry.line}`.toLowerCase().includes($('flow-filter').value.toLowerCase());
  }
  showFlow() {
    $('flow').replaceChildren(...this.lines.filter(entry => this.passes(entry)).map(entry => this.lineOf(entry)));
    $('flow').scrollTop = $('flow').scrollHeight;
  }
}
