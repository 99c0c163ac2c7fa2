// Which modules are there, and which the hub starts or has had. Tells of each that has come, also of one that comes
// again, and of each that has gone. `onCome` may return a promise: the modules are known when all have been fulfilled.
const kLookEveryMs = 5000;
const kComing = ['WAITING', 'RUNNING', 'RESTARTING'];  // in Processes; who is RUNNING and not there is starting

export class Presence {
  constructor(hub) {
    this.hub = hub;
    this.names = new Set();
    this.known = false;        // since the connection
    this.states = new Map();   // of the modules the hub starts
    this.seen = new Set();
    this.onLook = () => {};
    this.onCome = () => {};
    this.onGo = () => {};
    setInterval(() => this.look(), kLookEveryMs);
  }
  has(name) { return this.names.has(name); }
  lacks(name) { return !this.has(name) && (this.seen.has(name) || this.states.has(name)); }
  isComing(name) { return !this.has(name) && kComing.includes(this.states.get(name)); }

  async look() {
    const [answer, processes] = await Promise.all(
        ['inq Modules', 'inq Processes'].map(line => this.hub.ask(line).catch(() => null)));
    if (answer === null) return;
    this.states = new Map((processes ?? '').split(', ').filter(Boolean).map(part => part.split(' ')));
    const now = new Set(answer.split(/\s+/).filter(Boolean));
    for (const name of this.names) if (!now.has(name)) this.go(name);
    await Promise.all([...now].filter(name => !this.names.has(name)).map(name => this.come(name)));
    this.known = this.hub.on;
    this.onLook();
  }
  hear({from, slot, value}) {
    if (from === 'AM' && slot === '') this.look();  // the hub tells of an event: perhaps somebody has gone
    if (slot === 'Run' && value === 'LIVE' && from) this.come(from);
  }
  come(name) {
    this.names.add(name);
    this.seen.add(name);
    return this.onCome(name);
  }
  go(name) {
    if (this.names.delete(name)) this.onGo(name);
  }
  leave() {
    this.known = false;
    for (const name of [...this.names]) this.go(name);
  }
}
