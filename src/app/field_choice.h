// The flags of `render` that shape and show the world field.
#pragma once

#include <set>
#include <string>

#include "renderer/settings.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

struct FieldChoice {
  FieldSettings settings;
  FieldSlice slice;
  std::set<std::string> given; ///< flags of this group
};

/// Of the renderer's views and those that are made on the CPU; null: no such view.
const DebugView* findAnyView(const std::string& name);

/// --world-field --field-* --slice --cascade
/// error  BadInput at parsing: a value out of its range
void addFieldOptions(CLI::App& command, FieldChoice& choice);

/// Checks what flags can be told of each other and of the view, and settles what follows from the method.
///
/// view   of --view; empty: the picture
/// error  BadInput that names the flag: of another method, beside one that rules it out, or of a view that is not shown
/// proved by tests/unit/app/field_choice_test.cpp
void settleFieldChoice(FieldChoice& choice, const std::string& view, std::uint64_t seed);

} // namespace brickfield
