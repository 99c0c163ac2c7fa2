// The protocol in a page: one WebSocket, one line a message. A page is a client like any other, or,
// with a name and slots of its own, a module.
// A refusal, "CODE text", as an error that has both apart.
export class Refusal extends Error {
  constructor(value) {
    super(value);
    [, this.code, this.words] = value.match(/^([A-Z_0-9]+) (.*)$/) ?? [null, '', value];
  }
}

export class Galatea {
  constructor() {
    this.pending = new Map();
    this.last = 0;
    this.onReport = () => {};
    this.onFlow = () => {};
    this.onState = () => {};
    this.onCommand = () => {};
    this.onRefused = () => {};
    this.connect();
  }

  connect() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    this.socket = new WebSocket(`${scheme}//${location.host}/ws`, 'galatea');
    this.socket.onopen = () => this.onState(true);
    this.socket.onmessage = event => this.hear(event.data);
    this.socket.onclose = () => {
      for (const {reject} of this.pending.values()) reject(new Error('the hub has gone'));
      this.pending.clear();
      this.onState(false);
      this.lookWhy();
      setTimeout(() => this.connect(), 1000);
    };
  }

  get on() { return this.socket.readyState === WebSocket.OPEN; }

  // A browser does not tell a page why its WebSocket was refused; a request for a small file of the page does.
  lookWhy() {
    fetch('favicon.svg', {cache: 'no-store'}).then(
        answer => { if (!answer.ok) this.onRefused(answer.status); }, () => {});
  }

  send(line) {
    if (this.on) this.socket.send(line);
  }

  // A line without a tag: "to @SSM inq Speaker". Resolves to the value, rejects with the refusal.
  // The tag begins with `who`: w for what a page asks by itself, u for what its user asks.
  ask(line, who = 'w') {
    const tag = `${who}${++this.last}`;
    const words = line.trim().match(/^((?:to\s+\S+\s+)?)([a-z]+)(\s.*)?$/i);
    if (!words) return Promise.reject(new Error('that is no line of the protocol'));
    if (!this.on) return Promise.reject(new Error('the hub is away'));
    return new Promise((resolve, reject) => {
      this.pending.set(tag, {resolve, reject});
      this.send(`${words[1]}${words[2]}#${tag}${words[3] || ''}`);
    });
  }

  hear(line) {
    if (line.startsWith('# flow ')) {
      const [time, from, to, ...rest] = line.slice(7).split('\t');
      this.onFlow({time: Number(time), from, to, line: rest.join('\t')});
      return;
    }
    const report = line.match(/^(?:From @(\S+) )?rep(?:#(\S+))? (\S+)(?: = (.*))?$/);
    if (report) {
      const [, from, tag, slot, value = ''] = report;
      const asked = tag && this.pending.get(tag);
      if (asked && slot.endsWith('.error')) {
        this.pending.delete(tag);
        asked.reject(new Refusal(value));
      } else if (asked) {
        this.pending.delete(tag);
        asked.resolve(value);
      } else {
        this.onReport({from, slot, value});
      }
      return;
    }
    const told = line.match(/^(?:From @(\S+) )?tell (.*)$/);
    if (told) {
      this.onReport({from: told[1], slot: '', value: told[2]});
      return;
    }
    const command = line.match(/^(set|inq|prop|do)(?:#(\S+))? ?(\S*)(?: = (.*))?$/);
    if (command)
      this.onCommand({command: command[1], tag: command[2], slot: command[3], value: command[4] || ''});
  }
}
