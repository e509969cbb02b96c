// Where the project's files are.
#pragma once

namespace freeplay::test {

/// Absolute, without a slash at its end. In a file of its own: the others compile alike in every clone.
const char* source_folder();

}  // namespace freeplay::test
