// What a call says when it refuses its input.
#pragma once

#include <string>

#include "core/error.h"

namespace brickfield::test {

/// The text of the BadInput that `call` throws; "accepted" where it throws none. Other exceptions pass through.
template <typename Call>
std::string refusalOf(Call&& call) {
  try {
    call();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "accepted";
}

} // namespace brickfield::test
