// Notes for people, several in one text.
#pragma once

#include <string>

namespace flaunay::host {

/// Adds a further note, unless it is empty.
inline void append_note(std::string& note, const std::string& further) {
  if (!note.empty() && !further.empty()) note += "; ";
  note += further;
}

}  // namespace flaunay::host
