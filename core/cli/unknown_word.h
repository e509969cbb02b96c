// UnknownWord: commands, options and arguments that the program does not know.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace freeplay {

/// Throws Error{usage} for the first word that the parser left over: a command of a later release, an unknown command
/// or option with the nearest known one, or an argument too many.
void refuse_unknown_words(const CLI::App& program);

}  // namespace freeplay
