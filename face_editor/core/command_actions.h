#pragma once

#include <string>
#include <vector>

#include "face_editor/core/editor.h"

/// What the commands of a script do with the words after their name; of those, as many are there as
/// the command asks for.
namespace editor::actions {

using Answer = vm::Result<std::string>;
using Words = std::vector<std::string>;

Answer Done(vm::Result<void> result);
/// Error: kBadValue.
vm::Result<double> Number(const std::string& word);
vm::Result<int> Whole(const std::string& word);

Answer Select(Editor& editor, const Words& words);
Answer DragPoints(Editor& editor, const Words& words);
Answer SetReach(Editor& editor, const Words& words);
Answer Switched(const std::string& word, bool& value);
Answer SetUnit(Editor& editor, const Words& words);
Answer SetExpression(Editor& editor, const Words& words);
Answer KeepLook(Editor& editor, const Words& words);
Answer SetTiming(Editor& editor, const Words& words);
Answer SetMouth(Editor& editor, const Words& words, bool bilingual);
enum class KeyChange { kSet, kAdd, kRemove };
Answer ChangeKey(Editor& editor, const Words& words, KeyChange change);
Answer SetSlider(Editor& editor, const Words& words);
Answer SetRow(Editor& editor, const Words& words);
Answer AddRow(Editor& editor, const Words& words);
Answer RemoveRow(Editor& editor, const Words& words);
Answer LoadOrSave(Editor& editor, const Words& words, bool save);

Answer GetPoint(Editor& editor, const Words& words);
Answer GetViews(Editor& editor, const Words& words);
Answer GetExpression(Editor& editor, const Words& words);
Answer GetMouth(Editor& editor, const Words& words, bool bilingual);
Answer GetMotion(Editor& editor, const Words& words);
Answer GetSlider(Editor& editor, const Words& words);
/// The rows of a unit, numbered.
Answer GetRows(Editor& editor, const Words& words);
Answer GetUnsaved(Editor& editor, const Words& words);

}  // namespace editor::actions
