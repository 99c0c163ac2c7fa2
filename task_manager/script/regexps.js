// Run once in every new script engine, after prelude.js: regular expressions (ECMA-262 5th edition,
// 15.10.6, 15.5.4.10-12 and 14) on top of __match(source, flags, text, from), which gives the
// beginnings and ends of the match and its groups (-1: none) or null, and has a limit of its own.
(function (global) {
  'use strict';
  var find = global.__match;
  delete global.__match;

  function define(owner, name, value) {
    Object.defineProperty(owner, name, { value: value, writable: true, enumerable: false, configurable: true });
  }
  function isPattern(value) { return value instanceof RegExp && value !== RegExp.prototype; }
  function textOf(self) {
    if (self === undefined || self === null) throw new TypeError('no text');
    return String(self);
  }
  function flagsOf(pattern) { return (pattern.ignoreCase ? 'i' : '') + (pattern.multiline ? 'm' : ''); }
  function spansOf(pattern, text, from) { return find(String(pattern.source), flagsOf(pattern), text, from); }
  function part(text, spans, group) {
    return spans[2 * group] < 0 ? undefined : text.substring(spans[2 * group], spans[2 * group + 1]);
  }
  function parts(text, spans) {
    var all = [];
    for (var i = 0; 2 * i < spans.length; ++i) all[i] = part(text, spans, i);
    return all;
  }

  function exec(input) {
    if (!isPattern(this)) throw new TypeError('not a regular expression');
    var text = String(input), from = this.global ? Math.floor(Number(this.lastIndex)) || 0 : 0;
    var spans = from < 0 || from > text.length ? null : spansOf(this, text, from);
    if (!spans) {
      this.lastIndex = 0;
      return null;
    }
    if (this.global) this.lastIndex = spans[1];
    var result = parts(text, spans);
    result.index = spans[0];
    result.input = text;
    return result;
  }
  define(RegExp.prototype, 'exec', exec);
  define(RegExp.prototype, 'test', function (input) { return exec.call(this, input) !== null; });

  /// Calls each(spans) for every match (for the first one only if the pattern is not global).
  function eachMatch(pattern, text, each) {
    var from = 0;
    while (from <= text.length) {
      var spans = spansOf(pattern, text, from);
      if (!spans) break;
      each(spans);
      if (!pattern.global) return;
      from = spans[1] === spans[0] ? spans[1] + 1 : spans[1];
    }
    if (pattern.global) pattern.lastIndex = 0;
  }

  define(String.prototype, 'match', function (given) {
    var text = textOf(this), pattern = isPattern(given) ? given : new RegExp(given);
    if (!pattern.global) return exec.call(pattern, text);
    var all = [];
    eachMatch(pattern, text, function (spans) { all.push(part(text, spans, 0)); });
    return all.length ? all : null;
  });
  define(String.prototype, 'search', function (given) {
    var text = textOf(this), spans = spansOf(isPattern(given) ? given : new RegExp(given), text, 0);
    return spans ? spans[0] : -1;
  });

  /// $$, $&, $`, $' and $1 to $99 in a replacement.
  function expand(template, text, spans) {
    var groups = spans.length / 2 - 1, made = '', at = 0;
    for (var sign; (sign = template.indexOf('$', at)) >= 0;) {
      made += template.substring(at, sign);
      var next = template.charAt(sign + 1), two = template.substr(sign + 1, 2);
      at = sign + 2;
      if (next === '$') {
        made += '$';
      } else if (next === '&') {
        made += part(text, spans, 0);
      } else if (next === '`') {
        made += text.substring(0, spans[0]);
      } else if (next === "'") {
        made += text.substring(spans[1]);
      } else if (two.length === 2 && two >= '01' && two <= '99' && two.charAt(1) >= '0' &&
                 two.charAt(1) <= '9' && Number(two) <= groups) {
        made += part(text, spans, Number(two)) || '';
        at = sign + 3;
      } else if (next >= '1' && next <= '9' && Number(next) <= groups) {
        made += part(text, spans, Number(next)) || '';
      } else {
        made += '$';
        at = sign + 1;
      }
    }
    return made + template.substring(at);
  }
  var replaceText = String.prototype.replace;
  define(String.prototype, 'replace', function (pattern, replacement) {
    var text = textOf(this);
    if (!isPattern(pattern)) return replaceText.call(text, pattern, replacement);
    var pieces = [], at = 0;
    if (typeof replacement !== 'function') replacement = String(replacement);
    eachMatch(pattern, text, function (spans) {
      pieces.push(text.substring(at, spans[0]));
      if (typeof replacement === 'function') {
        pieces.push(String(replacement.apply(undefined, parts(text, spans).concat(spans[0], text))));
      } else {
        pieces.push(expand(replacement, text, spans));
      }
      at = spans[1];
    });
    return pieces.join('') + text.substring(at);
  });

  var splitText = String.prototype.split;
  define(String.prototype, 'split', function (pattern, limit) {
    var text = textOf(this);
    if (!isPattern(pattern)) return splitText.call(text, pattern, limit);
    var most = limit === undefined ? 4294967295 : limit >>> 0, all = [], taken = 0, at = 0, spans;
    if (most === 0) return all;
    if (text.length === 0) return spansOf(pattern, text, 0) ? all : [text];
    while (at < text.length && (spans = spansOf(pattern, text, at)) && spans[0] < text.length) {
      if (spans[1] === taken) {
        at = spans[0] + 1;
        continue;
      }
      all.push(text.substring(taken, spans[0]));
      for (var i = 1; i < spans.length / 2 && all.length < most; ++i) all.push(part(text, spans, i));
      if (all.length >= most) return all.slice(0, most);
      at = taken = spans[1];
    }
    all.push(text.substring(taken));
    return all;
  });
})(this);
