#include "task_manager/grammar/chart.h"

#include <algorithm>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/text.h"

namespace vxml::srgs {

using Kind = Expansion::Kind;

namespace {

bool IsLeaf(const Expansion& node) {
  return node.children.empty() && node.kind != Kind::kReference;
}

/// Steps that a machine word of memory counts for: it keeps a chart below 64 MB.
constexpr std::size_t kRoomCost = 8;

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || c == '\''; }

template <typename Visit>
void ForEach(const Places& places, const Visit& visit) {
  for (std::size_t at = places.find_first(); at != Places::npos; at = places.find_next(at)) {
    visit(at);
  }
}

}  // namespace

Chart::Chart(const std::string& input, bool dtmf, bool split_digits)
    : text_(dtmf ? FoldKeys(Fold(input)) : Fold(input)),
      dtmf_(dtmf),
      split_digits_(split_digits),
      limit_(kMaxSteps) {
  FindPlaces();
  work_.resize(size());
  words_ = 1 + size() / 64;
}

void Chart::FindPlaces() {
  place_at_.assign(text_.size() + 1, -1);
  for (std::size_t byte = 0;; byte += vm::SignAt(text_, byte).length) {
    if (byte == 0 || (AtWordEnd(byte) && text_[byte - 1] != ' ')) {
      place_at_[byte] = static_cast<std::int32_t>(bytes_.size());
      bytes_.push_back(byte);
    }
    if (byte >= text_.size()) break;
  }
}

bool Chart::AtWordEnd(std::size_t byte) const {
  if (dtmf_ || byte == text_.size() || text_[byte] == ' ') return true;
  if (split_digits_ && (!IsLetter(text_[byte - 1]) || !IsLetter(text_[byte]))) return true;
  return IsUnspaced(DecodeBefore(text_, byte)) || IsUnspaced(vm::SignAt(text_, byte).value);
}

std::size_t Chart::SkipBlank(std::size_t byte) const {
  return byte < text_.size() && text_[byte] == ' ' ? byte + 1 : byte;
}

std::string Chart::Words(std::size_t begin, std::size_t end) const {
  const std::size_t from = SkipBlank(bytes_[begin]);
  return text_.substr(from, bytes_[end] - from);
}

bool Chart::Spend(std::size_t steps) {
  steps_ += steps;
  return !over_limit();
}

Places Chart::Ends(const Expansion& node, std::size_t place) {
  if (over_limit()) return Places(size());
  if (IsLeaf(node)) return OfLeaf(node, place);
  const CellId id = Open(node, place);
  Run();
  return cells_[id].ends;
}

Places Chart::OfLeaf(const Expansion& node, std::size_t place) {
  Spend(words_);
  if (node.kind == Kind::kToken) return OfToken(node, place);
  Places ends(size());
  if (node.kind == Kind::kVoid || node.kind == Kind::kAlternatives) return ends;
  ends.set(place);
  if (node.kind == Kind::kGarbage) {
    touched_end_ = true;
    for (std::size_t end = place; end < size(); ++end) ends.set(end);
  }
  return ends;
}

Places Chart::OfToken(const Expansion& node, std::size_t place) {
  Places ends(size());
  if (node.folded.empty()) {
    ends.set(place);
    return ends;
  }
  const std::size_t from = SkipBlank(bytes_[place]);
  const std::string_view rest = std::string_view(text_).substr(from);
  if (rest.size() < node.folded.size()) {
    if (std::string_view(node.folded).starts_with(rest)) touched_end_ = true;
  } else if (rest.starts_with(node.folded)) {
    const std::int32_t end = place_at_[from + node.folded.size()];
    if (end >= 0) ends.set(static_cast<std::size_t>(end));
  }
  return ends;
}

/// The cell of an expansion that has parts, with its work queued if it is new.
Chart::CellId Chart::Open(const Expansion& node, std::size_t place) {
  const auto [found, is_new] =
      by_key_.try_emplace({&node, place}, static_cast<CellId>(cells_.size()));
  if (!is_new) return found->second;
  Cell cell{&node, place, 1, 1, false, {}, Places(size()), Places(size()), {}};
  if (node.kind == Kind::kSequence) cell.least = cell.most = node.children.size();
  if (node.kind == Kind::kRepeat) {
    // More turns than there are places left must hold an empty one, and then there may be any
    // number of empty ones; turns beyond the least take something.
    const std::size_t left = last() - place;
    const auto least = static_cast<std::size_t>(node.min);
    cell.least = std::min(least, left + 1);
    // One turn more than fits keeps "could go on" true only where it is.
    cell.endless = node.max == Expansion::kUnbounded || least > cell.least ||
                   static_cast<std::size_t>(node.max) > least + left;
    cell.most = cell.endless ? cell.least : static_cast<std::size_t>(node.max);
  }
  const CellId id = found->second;
  cells_.push_back(std::move(cell));
  Spend(16 + kRoomCost * 2 * words_);
  Places start(size());
  start.set(place);
  Enter(id, 0, start);
  return id;
}

void Chart::Run() {
  while (!over_limit()) {
    Work& work = work_[latest_];
    if (!work.steps.empty()) {
      const Step step = work.steps.back();
      work.steps.pop_back();
      Advance(step);
    } else if (!work.to_tell.empty()) {
      const CellId id = work.to_tell.back();
      work.to_tell.pop_back();
      Tell(id);
    } else if (latest_ == 0) {
      return;
    } else {
      --latest_;
    }
  }
}

void Chart::Advance(const Step& step) {
  Spend(words_);
  const Expansion& node = *cells_[step.cell].node;
  switch (node.kind) {
    case Kind::kReference:
      if (node.target && node.target->expansion) AdvanceThrough(step, *node.target->expansion);
      break;
    case Kind::kAlternatives:
      for (const auto& child : node.children) AdvanceThrough(step, *child);
      break;
    case Kind::kSequence:
    case Kind::kRepeat: {
      const auto& part = node.children[node.kind == Kind::kRepeat ? 0 : step.stage];
      if (!AdvanceThrough(step, *part)) work_[cells_[step.cell].place].steps.push_back(step);
      break;
    }
    default:
      break;
  }
}

bool Chart::AdvanceThrough(const Step& step, const Expansion& part) {
  if (IsLeaf(part)) {
    Reach(step.cell, step.stage, step.from, OfLeaf(part, step.from));
    return true;
  }
  const std::size_t place = cells_[step.cell].place;
  if (step.from > place && !by_key_.contains({&part, step.from})) {
    Open(part, step.from);
    return over_limit();
  }
  const CellId id = Open(part, step.from);
  if (step.from == place) cells_[id].listeners.push_back({step.cell, step.stage});
  Reach(step.cell, step.stage, step.from, cells_[id].ends);
  return true;
}

void Chart::Reach(CellId id, std::size_t stage, std::size_t from, Places ends) {
  const Cell& cell = cells_[id];
  if (cell.node->kind == Kind::kRepeat && stage >= cell.least) ends.reset(from);
  Enter(id, cell.endless && stage == cell.most ? stage : stage + 1, ends);
}

void Chart::Enter(CellId id, std::size_t stage, const Places& places) {
  Cell& cell = cells_[id];
  if (cell.stages.size() <= stage) {
    Spend(kRoomCost * words_ * (stage + 1 - cell.stages.size()));
    cell.stages.resize(stage + 1, Places(size()));
  }
  Spend(words_);
  const Places fresh = places - cell.stages[stage];
  if (fresh.none()) return;
  cell.stages[stage] |= fresh;
  Work& work = work_[cell.place];
  latest_ = std::max(latest_, cell.place);
  if (stage < cell.most || cell.endless) {
    ForEach(fresh, [&](std::size_t from) { work.steps.push_back({id, stage, from}); });
  }
  if (stage < cell.least) return;
  const Places ends = fresh - cell.ends;
  if (ends.none()) return;
  cell.ends |= ends;
  if (cell.untold.none()) work.to_tell.push_back(id);
  cell.untold |= ends;
}

void Chart::Tell(CellId id) {
  const Places news = cells_[id].untold;
  cells_[id].untold.reset();
  for (std::size_t i = 0; i < cells_[id].listeners.size(); ++i) {
    const Listener listener = cells_[id].listeners[i];
    Reach(listener.cell, listener.stage, cells_[id].place, news);
  }
}

}  // namespace vxml::srgs
