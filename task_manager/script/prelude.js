// Run once in every new script engine: helpers of engine.cc, a safe eval and Function, and the
// read-only DOM (Level 2 Core, the part VoiceXML 2.1 section 5 and appendix D ask for).
(function (global) {
  'use strict';
  var tick = global.__t, evaluate = global.__eval;
  function hide(name, value) {
    Object.defineProperty(global, name, { value: value, writable: false, enumerable: false });
  }
  delete global.__t;
  delete global.__eval;
  hide('__t', tick);
  // Scripts made from strings pass the same rewriting (step counting) as those of documents.
  Object.defineProperty(global, 'eval', { value: function (code) { return evaluate(code); } });
  function NoFunction() { throw new EvalError('Function() from text is not available'); }
  NoFunction.prototype = Function.prototype;
  Object.defineProperty(Function.prototype, 'constructor', { value: NoFunction });
  Object.defineProperty(global, 'Function', { value: NoFunction });
  delete global.Duktape;

  // The loops of the engine's own functions cannot be counted one by one: what they are going to
  // cost is charged beforehand, in steps. Called through `apply`, so scripts cannot get at them.
  var apply = Function.prototype.call.bind(Function.prototype.apply);
  function lengthOf(value) {
    return value === undefined || value === null ? 0 : value.length >>> 0;
  }
  function charge(owner, names, cost) {
    names.split(' ').forEach(function (name) {
      var inner = owner[name];
      if (typeof inner !== 'function') return;
      Object.defineProperty(owner, name, { writable: true, configurable: true, value: function () {
        tick(cost(this, arguments));
        return apply(inner, this, arguments);
      } });
    });
  }
  charge(Array.prototype, 'join reverse shift slice splice unshift indexOf lastIndexOf every some ' +
    'forEach map filter reduce reduceRight toString toLocaleString', lengthOf);
  charge(Array.prototype, 'sort', function (array) { return lengthOf(array) * 20; });
  charge(Array.prototype, 'concat', function (array, others) {
    var sum = lengthOf(array);
    for (var i = 0; i < others.length; ++i) sum += typeof others[i] === 'object' ? lengthOf(others[i]) : 1;
    return sum;
  });
  charge(String.prototype, 'indexOf lastIndexOf split replace includes startsWith endsWith', function (text, args) {
    return lengthOf(text) * (1 + (typeof args[0] === 'string' ? args[0].length / 16 : 0));
  });
  charge(String.prototype, 'toUpperCase toLowerCase toLocaleUpperCase toLocaleLowerCase trim ' +
    'localeCompare concat repeat', lengthOf);
  charge(JSON, 'parse', function (owner, args) { return lengthOf(args[0]); });
  charge(global, 'encodeURIComponent decodeURIComponent encodeURI decodeURI escape unescape parseInt parseFloat',
    function (owner, args) { return lengthOf(args[0]); });
  delete global.Proxy;

  // for (name in __f(object)): the names are charged for before the loop begins.
  var keys = Object.keys, prototypeOf = Object.getPrototypeOf, define = Object.defineProperty;
  hide('__f', function (object) {
    var count = 1;
    if (typeof object === 'string') count += object.length;
    for (var at = object; at && (typeof at === 'object' || typeof at === 'function'); at = prototypeOf(at)) {
      count += keys(at).length;
    }
    tick(count);
    return object;
  });
  // with (__w(object)): what the rewriter put in keeps its meaning inside.
  hide('__w', function (object) {
    tick();
    if (object && (typeof object === 'object' || typeof object === 'function')) {
      ['__t', '__f', '__w'].forEach(function (name) {
        if (name in object && object[name] !== global[name]) throw new TypeError('with: ' + name + ' is taken');
        if (Object.isExtensible(object)) {
          define(object, name, { value: global[name], writable: false, enumerable: false, configurable: false });
        }
      });
    }
    return object;
  });

  hide('__keys', function (o) { return (o && typeof o === 'object') ? Object.keys(o).join('\n') : ''; });
  hide('__json', function (v) {
    var seen = [];
    var text = JSON.stringify(v, function (key, value) {
      if (value instanceof Node) return '[' + value.nodeName + ']';
      if (typeof value === 'function') return String(value);
      if (value && typeof value === 'object') {
        if (seen.length > 10000) return '[...]';
        if (seen.indexOf(value) >= 0 && key !== '' && isCycle(value)) return '[cycle]';
        seen.push(value);
      }
      return value;
    });
    return text === undefined ? 'undefined' : text;
  });
  function isCycle(value) {
    try { JSON.stringify(value); return false; } catch (e) { return true; }
  }

  // --- DOM
  function DOMException(code, message) { this.code = code; this.message = message; }
  DOMException.prototype.toString = function () { return 'DOMException: ' + this.message; };
  var readOnly = 7;
  function refuse() { throw new DOMException(readOnly, 'the document is read-only'); }

  function Node() {}
  var types = ['ELEMENT', 'ATTRIBUTE', 'TEXT', 'CDATA_SECTION', 'ENTITY_REFERENCE', 'ENTITY',
    'PROCESSING_INSTRUCTION', 'COMMENT', 'DOCUMENT', 'DOCUMENT_TYPE', 'DOCUMENT_FRAGMENT', 'NOTATION'];
  types.forEach(function (t, i) { Node[t + '_NODE'] = Node.prototype[t + '_NODE'] = i + 1; });
  ['insertBefore', 'replaceChild', 'removeChild', 'appendChild', 'normalize', 'setAttribute',
    'setAttributeNS', 'removeAttribute', 'removeAttributeNS', 'setAttributeNode', 'removeAttributeNode',
    'createElement', 'createTextNode', 'createAttribute', 'importNode', 'appendData', 'insertData',
    'deleteData', 'replaceData', 'splitText'].forEach(function (m) { Node.prototype[m] = refuse; });
  Node.prototype.hasChildNodes = function () { return this.childNodes.length > 0; };
  Node.prototype.hasAttributes = function () { return !!this.attributes && this.attributes.length > 0; };
  Node.prototype.isSupported = function (f) { return /^(core|xml)$/i.test(f); };
  Node.prototype.cloneNode = function (deep) { return build(copy(this, deep), null, this.ownerDocument); };
  Object.defineProperty(Node.prototype, 'textContent', { get: function () {
    if (this.nodeType === 3 || this.nodeType === 4 || this.nodeType === 2) return this.nodeValue;
    return this.childNodes.map(function (c) { return c.nodeType === 8 || c.nodeType === 7 ? '' : c.textContent; }).join('');
  } });
  function lazy(name, find) {
    Object.defineProperty(Node.prototype, name, { get: find, set: refuse });
  }
  lazy('firstChild', function () { return this.childNodes[0] || null; });
  lazy('lastChild', function () { return this.childNodes[this.childNodes.length - 1] || null; });
  function sibling(step) {
    return function () {
      if (!this.parentNode || this.nodeType === 2) return null;
      var all = this.parentNode.childNodes;
      return all[all.indexOf(this) + step] || null;
    };
  }
  lazy('nextSibling', sibling(1));
  lazy('previousSibling', sibling(-1));

  function list(items) {
    Object.defineProperty(items, 'item', { value: function (i) { return items[i] || null; } });
    return items;
  }
  function attributeMap(items) {
    list(items);
    Object.defineProperty(items, 'getNamedItem', { value: function (n) {
      for (var i = 0; i < items.length; i++) if (items[i].nodeName === n) return items[i];
      return null;
    } });
    Object.defineProperty(items, 'getNamedItemNS', { value: function (ns, n) {
      for (var i = 0; i < items.length; i++) {
        if (items[i].localName === n && (items[i].namespaceURI || '') === (ns || '')) return items[i];
      }
      return null;
    } });
    return items;
  }
  function local(name) { var c = name.indexOf(':'); return c < 0 ? name : name.slice(c + 1); }
  function prefix(name) { var c = name.indexOf(':'); return c < 0 ? null : name.slice(0, c); }

  Node.prototype.getAttributeNode = function (n) { return this.attributes.getNamedItem(n); };
  Node.prototype.getAttribute = function (n) { var a = this.getAttributeNode(n); return a ? a.value : ''; };
  Node.prototype.hasAttribute = function (n) { return this.getAttributeNode(n) !== null; };
  Node.prototype.getAttributeNodeNS = function (ns, n) { return this.attributes.getNamedItemNS(ns, n); };
  Node.prototype.getAttributeNS = function (ns, n) { var a = this.getAttributeNodeNS(ns, n); return a ? a.value : ''; };
  Node.prototype.hasAttributeNS = function (ns, n) { return this.getAttributeNodeNS(ns, n) !== null; };
  function descendants(node, wanted, into) {
    node.childNodes.forEach(function (c) {
      if (c.nodeType !== 1) return;
      if (wanted(c)) into.push(c);
      descendants(c, wanted, into);
    });
    return into;
  }
  Node.prototype.getElementsByTagName = function (n) {
    return list(descendants(this, function (c) { return n === '*' || c.nodeName === n; }, []));
  };
  Node.prototype.getElementsByTagNameNS = function (ns, n) {
    return list(descendants(this, function (c) {
      return (n === '*' || c.localName === n) && (ns === '*' || (c.namespaceURI || '') === (ns || ''));
    }, []));
  };
  Node.prototype.getElementById = function (id) {
    var found = descendants(this, function (c) { return c.getAttribute('id') === id || c.getAttribute('xml:id') === id; }, []);
    return found[0] || null;
  };
  Node.prototype.substringData = function (from, count) { return this.nodeValue.substr(from, count); };

  // spec: [type, name, value, namespace, attributes [[name, namespace, value]], children]
  function copy(node, deep) {
    return [node.nodeType, node.nodeName, node.nodeValue, node.namespaceURI,
      (node.attributes || []).map(function (a) { return [a.nodeName, a.namespaceURI, a.value]; }),
      deep ? node.childNodes.map(function (c) { return copy(c, true); }) : []];
  }
  function build(spec, parent, doc) {
    var node = new Node();
    node.nodeType = spec[0];
    node.nodeName = spec[1];
    node.nodeValue = spec[2];
    node.namespaceURI = spec[3] || null;
    node.parentNode = parent;
    node.ownerDocument = doc;
    node.attributes = null;
    node.localName = node.prefix = null;
    if (node.nodeType === 1) {
      node.tagName = node.nodeName;
      node.localName = local(node.nodeName);
      node.prefix = prefix(node.nodeName);
      node.attributes = attributeMap(spec[4].map(function (a) {
        var attr = new Node();
        attr.nodeType = 2;
        attr.nodeName = attr.name = a[0];
        attr.nodeValue = attr.value = a[2];
        attr.namespaceURI = a[1] || null;
        attr.localName = local(a[0]);
        attr.prefix = prefix(a[0]);
        attr.ownerElement = node;
        attr.ownerDocument = doc;
        attr.parentNode = null;
        attr.specified = true;
        attr.attributes = null;
        attr.childNodes = list([]);
        return Object.freeze(attr);
      }));
      Object.freeze(node.attributes);
    }
    if (node.nodeType === 3 || node.nodeType === 4 || node.nodeType === 8) {
      node.data = node.nodeValue;
      node.length = node.nodeValue.length;
    }
    if (node.nodeType === 7) { node.target = node.nodeName; node.data = node.nodeValue; }
    node.childNodes = list(spec[5].map(function (c) { return build(c, node, doc); }));
    Object.freeze(node.childNodes);
    return Object.freeze(node);
  }
  hide('__dom', function (spec) {
    var doc = new Node();
    doc.nodeType = 9;
    doc.nodeName = '#document';
    doc.nodeValue = null;
    doc.namespaceURI = doc.localName = doc.prefix = doc.parentNode = doc.ownerDocument = doc.attributes = doc.doctype = null;
    doc.implementation = Object.freeze({ hasFeature: function (f) { return /^(core|xml)$/i.test(f); } });
    doc.childNodes = list([]);
    doc.documentElement = build(spec, doc, doc);
    doc.childNodes.push(doc.documentElement);
    Object.freeze(doc.childNodes);
    return Object.freeze(doc);
  });
  hide('Node', Node);
  hide('DOMException', DOMException);
})(this);
