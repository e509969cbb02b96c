// Completion: how a command line that is being typed can go on, for shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace freeplay {

/// What the last of `words` (those after the program's name) can become: commands, options, values that the help
/// names, types, models and other files, and names of the model that stands on the line. A word that ends in '/' or '='
/// goes on. Nothing where nothing fits; loads no plugin that only a model names.
std::vector<std::string> completions(const CLI::App& program, const std::vector<std::string>& words);

}  // namespace freeplay
