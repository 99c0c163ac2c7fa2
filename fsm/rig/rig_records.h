#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "fsm/rig/rig_data.h"
#include "fsm/rig/steps.h"

namespace fsm {

/// The vertex data that a kernel of render/shaders/rig_kernels.glsl reads: records, and entries
/// where records have lists. Both hold structs of steps.glsl in their memory layout.
struct KernelRecords {
  const char* kernel;     ///< its name after STEP_
  std::size_t count = 0;  ///< number of records, which is the number of invocations
  std::vector<std::byte> records;
  std::vector<std::byte> entries;
};

/// Collects the records of kernels in the order in which these run, without those that do nothing.
class RecordCollector {
 public:
  template <typename Record, typename Entry = step::ListRecord>
  void Add(const char* kernel, const std::vector<Record>& records,
           const std::vector<Entry>& entries = {}) {
    if (records.empty()) return;
    all_.push_back({kernel, records.size(), BytesOf(records), BytesOf(entries)});
  }
  std::vector<KernelRecords> Release() { return std::move(all_); }

 private:
  template <typename T>
  static std::vector<std::byte> BytesOf(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) == sizeof(float));
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
  }

  std::vector<KernelRecords> all_;
};

/// Lists of the entries that act on each vertex. Entries keep their order, so that sums are
/// computed in the same order as on the processor.
template <typename Entry>
class VertexLists {
 public:
  explicit VertexLists(std::size_t vertices) : lists_(vertices) {}
  std::vector<Entry>& operator[](std::uint32_t vertex) { return lists_[vertex]; }
  /// Adds a record for each vertex with a non-empty list.
  void AddTo(RecordCollector& out, const char* kernel) const {
    std::vector<step::ListRecord> records;
    std::vector<Entry> entries;
    for (std::uint32_t vertex = 0; vertex < lists_.size(); ++vertex) {
      if (lists_[vertex].empty()) continue;
      const auto from = static_cast<std::uint32_t>(entries.size());
      entries.insert(entries.end(), lists_[vertex].begin(), lists_[vertex].end());
      records.push_back({vertex, from, static_cast<std::uint32_t>(entries.size())});
    }
    out.Add(kernel, records, entries);
  }

 private:
  std::vector<std::vector<Entry>> lists_;  // by vertex
};

/// Returns the records of all kernels that move a head, in order.
std::vector<KernelRecords> PackRig(const RigData& data);

}  // namespace fsm
