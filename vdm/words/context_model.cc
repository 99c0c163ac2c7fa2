#include "vdm/words/context_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "vdm/features/model_definition.h"

namespace vdm {
namespace {

constexpr std::size_t kMostPhones = 128, kMostSequences = 65536;

}  // namespace

vm::Result<std::shared_ptr<const ContextModel>> ContextModel::Read(
    const std::string& folder, std::shared_ptr<const PhoneModel> phones) {
  auto model = std::make_shared<ContextModel>();
  model->phones_ = std::move(phones);
  if (auto read = model->ReadContexts(folder); !read) return std::unexpected(read.error());
  if (auto read = model->ReadMixtures(folder); !read) return std::unexpected(read.error());
  return model;
}

vm::Result<void> ContextModel::ReadContexts(const std::string& folder) {
  auto file = ModelFile::Open(folder + "/mdef");
  if (!file) return std::unexpected(file.error());
  const auto definition = ReadDefinition(*file);
  if (!definition) return std::unexpected(definition.error());
  const std::size_t plain = definition->phones.size();
  if (definition->phones != phones_->phones() || definition->triphones < plain) {
    return file->Wrong("the phones of the Gaussians expected");
  }
  if (plain > kMostPhones || definition->sequences > kMostSequences) {
    return file->Wrong("more than 128 phones or 65536 sequences of states found");
  }
  for (std::size_t i = 0; i < plain; ++i) {
    noise_.push_back(definition->phones[i].starts_with('+'));
    if (definition->phones[i] == "SIL") silence_ = static_cast<Phone>(i);
  }
  tree_.resize(definition->tree_nodes);
  for (TreeNode& node : tree_) {
    node.context = file->Value<std::int16_t>();
    node.count = file->Value<std::uint16_t>();
    node.below = file->Value<std::uint32_t>();
    const bool fits = node.count > 0 ? std::size_t{node.below} + node.count <= tree_.size()
                                     : node.below < definition->triphones || node.below == kNothing;
    if (!file->ok() || !fits) {
      return file->Wrong("a context that leads out of the file found");
    }
  }
  roots_ = std::min<std::size_t>(tree_.size(), 4);
  triphones_.resize(definition->triphones);
  for (std::size_t i = 0; i < triphones_.size(); ++i) {
    const std::size_t sequence = file->Count();
    file->Count();                                 // transition matrix
    const std::string attributes = file->Text(4);  // place, phone, left, right
    const std::size_t base =
        i < plain || !file->ok() ? i : static_cast<std::uint8_t>(attributes[1]);
    if (!file->ok() || sequence >= definition->sequences || base >= plain) {
      return file->Wrong("states or a phone that are not there found");
    }
    triphones_[i] = {static_cast<Sequence>(sequence), static_cast<Phone>(base)};
  }
  if (file->Count() != definition->sequences * PhoneModel::kStates) {
    return file->Wrong("three states for each sequence expected");
  }
  sequences_.resize(definition->sequences);
  bases_.assign(definition->senones, 0);
  for (auto& sequence : sequences_) {
    for (std::uint16_t& senone : sequence) {
      senone = file->Value<std::uint16_t>();
      if (!file->ok() || senone >= definition->senones) {
        return file->Wrong("a state that is not there found");
      }
    }
  }
  for (const Triphone& triphone : triphones_) {
    for (const std::uint16_t senone : sequences_[triphone.sequence]) bases_[senone] = triphone.base;
  }
  return {};
}

vm::Result<void> ContextModel::ReadMixtures(const std::string& folder) {
  const std::size_t densities = phones_->densities(), senones = bases_.size();
  const auto weights = ReadWeights(folder, densities, senones);
  if (!weights) return std::unexpected(weights.error());
  weights_.resize(weights->size());
  for (std::size_t row = 0; row < PhoneModel::kStreams * densities; ++row) {
    for (std::size_t senone = 0; senone < senones; ++senone) {
      weights_[senone * PhoneModel::kStreams * densities + row] =
          static_cast<std::uint8_t>((*weights)[row * senones + senone]);
    }
  }
  return {};
}

const ContextModel::Triphone* ContextModel::Find(Phone phone, Phone left, Phone right,
                                                 Place place) const {
  const auto beside = [&](Phone other) { return noise_[other] ? silence_ : other; };
  const TreeNode* level = tree_.data();
  std::size_t count = roots_;
  for (const int context :
       {static_cast<int>(place), int{phone}, int{beside(left)}, int{beside(right)}}) {
    const auto* found =
        std::find_if(level, level + count, [&](const TreeNode& n) { return n.context == context; });
    if (found == level + count) return nullptr;
    if (found->count == 0) {
      return found->below == kNothing ? nullptr : &triphones_[found->below];
    }
    level = tree_.data() + found->below;
    count = found->count;
  }
  return nullptr;
}

ContextModel::Sequence ContextModel::SequenceOf(Phone phone, Phone left, Phone right,
                                                Place place) const {
  const Triphone* found = Find(phone, left, right, place);
  if (found == nullptr) found = Find(phone, left, right, Place::kInside);
  return found != nullptr ? found->sequence : SequenceOf(phone);
}

ContextScorer::ContextScorer(const ContextModel& model)
    : model_(model),
      nearest_(model.phones().phones().size()),
      phone_frame_(nearest_.size()),
      senone_frame_(model.bases_.size()),
      scores_(model.bases_.size()),
      densities_(PhoneModel::kStreams * model.phones().densities()),
      order_(model.phones().densities()) {}

void ContextScorer::Begin(const float* features) {
  features_ = features;
  ++frame_;
}

void ContextScorer::ScorePhone(std::size_t phone) {
  model_.phones().Densities(phone, features_, densities_);
  const std::size_t count = order_.size();
  for (std::size_t s = 0; s < PhoneModel::kStreams; ++s) {
    const float* likely = densities_.data() + s * count;
    std::iota(order_.begin(), order_.end(), std::uint16_t{0});
    std::partial_sort(order_.begin(), order_.begin() + kTop, order_.end(),
                      [&](std::uint16_t a, std::uint16_t b) { return likely[a] > likely[b]; });
    Stream& stream = nearest_[phone][s];
    for (std::size_t i = 0; i < kTop; ++i) {
      stream.densities[i] = order_[i];
      stream.likely[static_cast<Eigen::Index>(i)] = likely[order_[i]];
    }
  }
  phone_frame_[phone] = frame_;
}

float ContextScorer::Of(ContextModel::Sequence sequence, std::size_t state) {
  const std::size_t senone = model_.sequences_[sequence][state];
  if (senone_frame_[senone] == frame_) return scores_[senone];
  senone_frame_[senone] = frame_;
  const std::size_t phone = model_.bases_[senone];
  if (phone_frame_[phone] != frame_) ScorePhone(phone);
  const std::size_t count = order_.size();
  const std::uint8_t* weights = &model_.weights_[senone * PhoneModel::kStreams * count];
  float score = 0;
  for (const Stream& stream : nearest_[phone]) {
    Top parts = stream.likely;
    for (std::size_t i = 0; i < kTop; ++i) {
      parts[static_cast<Eigen::Index>(i)] += WeightOf(weights[stream.densities[i]]);
    }
    const float most = parts.maxCoeff();
    score += most + std::log((parts - most).exp().sum());
    weights += count;
  }
  return scores_[senone] = score;
}

}  // namespace vdm
