#include "vdm/words/context_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// The states in the order of their phones, so that those of one are computed together.
vm::Result<void> ContextModel::ReadMixtures(const std::string& folder) {
  const std::size_t rows = PhoneModel::kStreams * phones_->densities(), senones = bases_.size();
  const auto weights = ReadWeights(folder, phones_->densities(), senones);
  if (!weights) return std::unexpected(weights.error());
  std::vector<std::uint16_t> order(senones), place(senones);
  std::iota(order.begin(), order.end(), std::uint16_t{0});
  std::ranges::sort(order, {},
                    [&](std::uint16_t senone) { return std::pair(bases_[senone], senone); });
  std::ranges::sort(bases_);
  for (std::size_t phone = 0; phone <= phones_->phones().size(); ++phone) {
    first_.push_back(
        static_cast<std::size_t>(std::ranges::lower_bound(bases_, phone) - bases_.begin()));
  }
  for (std::size_t i = 0; i < senones; ++i) place[order[i]] = static_cast<std::uint16_t>(i);
  for (auto& sequence : sequences_) {
    for (std::uint16_t& senone : sequence) senone = place[senone];
  }
  weights_.reserve(rows * senones);
  for (std::size_t phone = 0; phone < phones_->phones().size(); ++phone) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = first_[phone]; i < first_[phone + 1]; ++i) {
        const char byte = (*weights)[row * senones + order[i]];
        weights_.push_back(std::exp(WeightOf(static_cast<unsigned char>(byte))));
      }
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
      phone_frame_(model.phones().phones().size()),
      scores_(static_cast<Eigen::Index>(model.bases_.size())),
      mixture_(scores_.size()),
      densities_(PhoneModel::kStreams * model.phones().densities()) {}

void ContextScorer::Begin(const float* features) {
  features_ = features;
  ++frame_;
}

/// The kTop likeliest of a stream's Gaussians, by insertion: few of many come among them.
void ContextScorer::FindNearest(std::span<const float> likely) {
  nearest_.fill({.likely = -std::numeric_limits<float>::infinity()});
  for (std::size_t i = 0; i < likely.size(); ++i) {
    if (!(likely[i] > nearest_.back().likely)) continue;
    std::size_t at = kTop - 1;
    for (; at > 0 && likely[i] > nearest_[at - 1].likely; --at) nearest_[at] = nearest_[at - 1];
    nearest_[at] = {i, likely[i]};
  }
}

/// All states of a phone.
void ContextScorer::ScorePhone(std::size_t phone) {
  phone_frame_[phone] = frame_;
  model_.phones().Densities(phone, features_, densities_);
  const std::size_t count = model_.phones().densities();
  const std::size_t first = model_.first_[phone], size = model_.first_[phone + 1] - first;
  const float* weights = &model_.weights_[first * PhoneModel::kStreams * count];
  auto scores = scores_.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(size));
  auto mixture = mixture_.head(scores.size());
  // What three mixtures multiply to is at least e^-78.4 (WeightOf), so that a float can hold it.
  scores.setOnes();
  float most = 0;
  for (std::size_t s = 0; s < PhoneModel::kStreams; ++s, weights += count * size) {
    FindNearest(std::span(densities_).subspan(s * count, count));
    mixture.setZero();
    for (const Nearest& near : nearest_) {
      mixture += std::exp(near.likely - nearest_[0].likely) *
                 Eigen::Map<const Eigen::ArrayXf>(weights + near.density * size, scores.size());
    }
    scores *= mixture;
    most += nearest_[0].likely;
  }
  scores = scores.log() + most;
}

float ContextScorer::Of(ContextModel::Sequence sequence, std::size_t state) {
  const std::size_t senone = model_.sequences_[sequence][state];
  const std::size_t phone = model_.bases_[senone];
  if (phone_frame_[phone] != frame_) ScorePhone(phone);
  return scores_[static_cast<Eigen::Index>(senone)];
}

}  // namespace vdm
