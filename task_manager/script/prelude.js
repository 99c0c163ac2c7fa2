// Evaluated once in every new script engine; its value is the helpers of engine.cc: JSON text of any
// value, and the read-only DOM (Level 2 Core, the part VoiceXML 2.1 section 5 and appendix D ask for).
(function (global) {
  'use strict';
  function hide(name, value) {
    Object.defineProperty(global, name, { value: value, writable: false, enumerable: false });
  }
  // Scripts may replace these later.
  const stringify = JSON.stringify;

  function json(value) {
    const open = [];
    const text = stringify(value, function (key, inner) {
      if (inner instanceof Node) return '[' + inner.nodeName + ']';
      if (typeof inner === 'function' || typeof inner === 'symbol' || typeof inner === 'bigint') return String(inner);
      if (inner === null || typeof inner !== 'object') return inner;
      while (open.length > 0 && open[open.length - 1] !== this) open.pop();
      if (open.includes(inner)) return '[cycle]';
      open.push(inner);
      return inner;
    });
    return text === undefined ? 'undefined' : text;
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
  function dom(specs) {
    const doc = new Node();
    doc.nodeType = 9;
    doc.nodeName = '#document';
    doc.nodeValue = null;
    doc.namespaceURI = doc.localName = doc.prefix = doc.parentNode = doc.ownerDocument = doc.attributes = doc.doctype = null;
    doc.implementation = Object.freeze({ hasFeature: function (f) { return /^(core|xml)$/i.test(f); } });
    doc.childNodes = list(specs.map(function (spec) { return build(spec, doc, doc); }));
    doc.documentElement = doc.childNodes.find(function (c) { return c.nodeType === 1; });
    Object.freeze(doc.childNodes);
    return Object.freeze(doc);
  }
  hide('Node', Node);
  hide('DOMException', DOMException);
  return { json: json, dom: dom };
})(globalThis)
