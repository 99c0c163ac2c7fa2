// Which modules are there. Tells of each that has come, also of one that comes again, and of each that has gone.
const kLookEveryMs = 5000;

export class Presence {
  constructor(hub) {
    this.hub = hub;
    this.names = new Set();
    this.onCome = () => {};
    this.onGo = () => {};
    setInterval(() => this.look(), kLookEveryMs);
  }
  has(name) { return this.names.has(name); }

  async look() {
    const answer = await this.hub.ask('inq Modules').catch(() => null);
    if (answer === null) return;
    const now = new Set(answer.split(/\s+/).filter(Boolean));
    for (const name of this.names) if (!now.has(name)) this.go(name);
    for (const name of now) if (!this.names.has(name)) this.come(name);
  }
  hear({from, slot, value}) {
    const gone = from === 'AM' && slot === '' && value.match(/^@(\S+) has gone/);
    if (gone) this.go(gone[1]);
    if (slot === 'Run' && value === 'LIVE' && from) this.come(from);
  }
  come(name) {
    this.names.add(name);
    this.onCome(name);
  }
  go(name) {
    if (this.names.delete(name)) this.onGo(name);
  }
  leave() { for (const name of [...this.names]) this.go(name); }
}
