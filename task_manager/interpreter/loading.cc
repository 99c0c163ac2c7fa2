#include <charconv>

#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/dialog_session.h"

namespace vxml {

void DialogSession::ThrowFetch(const fetch::Failure& failure) {
  std::string event = "error.badfetch";
  if (failure.http_status > 0) event += ".http." + std::to_string(failure.http_status);
  if (failure.code == vm::Errc::kAccess) event = "error.noauthorization";
  ThrowEvent(event, failure.text);
}

std::string DialogSession::BaseOf(const vm::xml::Node& node) const {
  // Handlers act as if copied into the active dialog: its document's base counts, unless an
  // element between them says otherwise.
  for (const vm::xml::Node* at = &node; at && at->parent; at = at->parent) {
    if (const std::string* base = at->Find("xml:base")) {
      return fetch::Resolve(context_->document->base, *base);
    }
  }
  return context_->document->base;
}

const VxmlDocument& DialogSession::OriginOf(const vm::xml::Node& node) const {
  const vm::xml::Node* top = &node;
  while (top->parent) top = top->parent;
  const bool of_root = context_->root && top == context_->root->root.get();
  return of_root ? *context_->root : *context_->document;
}

/// error.noauthorization unless the element came from a file of this machine.
void DialogSession::RequireLocal(const vm::xml::Node& node) const {
  const std::string& uri = OriginOf(node).uri;
  if (fetch::IsLocal(uri)) return;
  ThrowEvent("error.noauthorization",
             uri + ":" + std::to_string(node.line) + ": <" + node.name + "> only runs from files");
}

/// maxage, maxstale and fetchtimeout of the element, or of the properties for its kind of fetch.
fetch::Request DialogSession::FetchOptions(const vm::xml::Node& node, const char* kind) {
  fetch::Request request;
  request.from = OriginOf(node).uri;
  const auto seconds = [&](const char* name) -> std::optional<long long> {
    std::string text = node.Get(name);
    if (text.empty()) text = Property(std::string(kind) + name, &node);
    if (text.empty()) return {};
    if (text.ends_with("s")) text.pop_back();
    long long value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc()) return {};
    return value;
  };
  request.max_age = seconds("maxage");
  request.max_stale = seconds("maxstale");
  std::string timeout = node.Get("fetchtimeout");
  if (timeout.empty()) timeout = Property("fetchtimeout", &node);
  request.timeout = ParseTime(timeout);
  return request;
}

fetch::Response DialogSession::FetchFor(const vm::xml::Node& node, fetch::Request request,
                                        const char* kind) {
  std::string audio = node.Get("fetchaudio");
  if (audio.empty()) audio = Property("fetchaudio", &node);
  const bool waits = !audio.empty() && context_ && !hung_up_;
  if (waits) Flush();  // fetchaudio: what is queued is heard while fetching
  const bool slow = request.uri.starts_with("http") && Property("attention", &node) != "false";
  if (slow || waits) platform_.Fetching(waits ? fetch::Resolve(BaseOf(node), audio) : "", true);
  auto got = fetcher_.Fetch(request);
  if (slow || waits) platform_.Fetching("", false);
  JsonLine line;
  line.Text("uri", request.uri).Text("kind", kind).Bool("ok", got.has_value());
  if (got) line.Bool("cached", got->from_cache);
  if (!got) line.Text("error", got.error().text);
  Trace("fetch", line);
  if (!got) ThrowFetch(got.error());
  return std::move(*got);
}

std::shared_ptr<VxmlDocument> DialogSession::Load(const fetch::Request& request) {
  const fetch::Response got = FetchFor(Here(), request, "document");
  const std::string uri = fetch::WithoutFragment(got.uri);
  // The same bytes of the same place are parsed once: long sessions do not grow by going round.
  const std::size_t hash = std::hash<std::string>()(got.body);
  for (const auto& [key, document] : parsed_) {
    if (key.first == uri && key.second == hash) return document;
  }
  auto document = LoadDocument(got.body, uri, got.charset);
  if (!document) ThrowEvent("error.badfetch", document.error().text);
  parsed_.push_back({{uri, hash}, *document});
  return *document;
}

std::shared_ptr<VxmlDocument> DialogSession::LoadRoot(const VxmlDocument& document) {
  if (!fetch::MayRead(document.uri, document.application)) {  // nor share a root that is here
    ThrowEvent("error.noauthorization",
               document.uri + ": its application root " + document.application + " is a file");
  }
  if (context_ && context_->root && context_->root->uri == document.application &&
      context_->root->root->IsElement("vxml")) {
    return context_->root;
  }
  fetch::Request request = FetchOptions(Here(), "document");
  request.uri = document.application;
  auto root = Load(request);
  if (!root->application.empty()) {
    ThrowEvent("error.semantic",
               document.application + ": an application root with a root of its own");
  }
  return root;
}

/// Where a reference leads: loads what has to be loaded, so that a failure is the referrer's.
Transition DialogSession::Locate(const vm::xml::Node& node, const std::string& reference,
                                 const char* kind, std::vector<fetch::Field> fields, bool post,
                                 bool multipart, bool is_submit) {
  Transition to;
  const std::string uri = fetch::Resolve(BaseOf(node), reference);
  const std::string fragment = fetch::Fragment(uri);
  const bool only_fragment = reference.starts_with("#") && !is_submit;
  if (only_fragment) {
    to.document = context_->document;
    to.root = context_->root;
    to.same_document = true;
  } else {
    fetch::Request request = FetchOptions(node, "document");
    static_cast<void>(kind);
    request.uri = uri;
    request.fields = std::move(fields);
    request.post = post;
    request.multipart = multipart;
    to.document = Load(request);
    to.root = to.document->application.empty() ? to.document : LoadRoot(*to.document);
    if (to.root == to.document && context_->root && context_->root->uri == to.document->uri &&
        context_->root->root->IsElement("vxml")) {
      to.fresh_application = is_submit || fetch::HasQuery(uri);
    }
  }
  if (fragment.empty()) {
    to.dialog = to.document->dialogs.empty() ? nullptr : to.document->dialogs.front();
  } else {
    to.dialog = to.document->FindDialog(fragment);
    if (!to.dialog) ThrowEvent("error.badfetch", uri + ": there is no dialog '" + fragment + "'");
  }
  return to;
}

}  // namespace vxml
