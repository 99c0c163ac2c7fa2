#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vdm/train/head_training.h"

namespace vdm {

/// What the trainer tells people meanwhile, a line at a time.
using Progress = std::function<void(const std::string&)>;

/// The network of heads from speech that was made: talks of six sentences, each as it is and once
/// as if it had come from elsewhere (Distorted), the truth what the face does when it is told the
/// text. From recordings: as ReadHeadLessons says. Both give the text of the file.
/// Errors: those of the list; kBadValue for takes too few.
vm::Result<std::string> TeachHead(const HeadPlan& plan, const std::vector<Take>& takes,
                                  const fsm::MotionTables& tables, const Progress& progress);
vm::Result<std::string> TeachHead(const HeadPlan& plan, const std::string& list,
                                  const Progress& progress);

}  // namespace vdm
