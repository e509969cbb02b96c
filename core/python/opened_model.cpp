#include "python/opened_model.h"

#include <algorithm>
#include <utility>

#include "base/message_json.h"
#include "convert/model_json.h"
#include "drawing/mechanism_drawing.h"
#include "load/facts.h"
#include "load/model_file.h"
#include "python/refusal.h"
#include "results/made_text.h"

namespace freeplay {
namespace {

LoadedModel read(const OpenRequest& request, const BuildOptions& build, std::vector<std::string>& remarks) {
  LoadOptions options{request.load};
  options.warn = options.note = [&](const std::string& text) { remarks.push_back(text); };
  return request.text ? load_text(*request.text, request.file, build, options)
                      : load_model(request.file, build, options);
}

LoadedModel read_whole(const OpenRequest& request, std::vector<std::string>& remarks) {
  LoadedModel loaded = read(request, build_options(request.words), remarks);
  if (!loaded.model) throw Refusal(loaded.diagnostics, loaded.exit_code);
  if (!request.name.empty()) loaded.model->name = request.name;
  return loaded;
}

}  // namespace

OpenedModel::OpenedModel(OpenRequest request)
    : request_(std::move(request)), loaded_(read_whole(request_, remarks_)), channels_(*loaded_.model) {}

OpenedModel::~OpenedModel() { delete assembled_.load(); }

Json OpenedModel::check(const OpenRequest& request) {
  std::vector<std::string> remarks;
  LoadedModel loaded = read(request, build_options(request.words), remarks);
  if (loaded.model) assemble_model(loaded);
  return messages_json(loaded.diagnostics, 0);
}

std::string OpenedModel::unit_of(const std::string& parameter) const {
  const auto found = std::ranges::find(model().parameters, parameter, &std::pair<std::string, Quantity>::first);
  return found == model().parameters.end() ? std::string() : si_unit(found->second.dimension);
}

Json OpenedModel::messages() const { return messages_json(loaded_.diagnostics, 0); }

std::unique_ptr<AssembledModel> OpenedModel::assemble(Diagnostics& diagnostics) const {
  diagnostics = loaded_.diagnostics;
  int exit_code = 0;
  auto assembled = assemble_model(model(), &*loaded_.document, diagnostics, exit_code);
  if (!assembled) throw Refusal(diagnostics, exit_code);
  return assembled;
}

OpenRequest OpenedModel::same_text() const {
  OpenRequest request = request_;
  if (!is_robot(request.file)) request.text = model().text;  // whatever the file has become
  return request;
}

LoadedModel OpenedModel::read_again() const {
  std::vector<std::string> remarks;
  return read_whole(same_text(), remarks);
}

LoadedModel OpenedModel::read_with(const BuildOptions& build) const {
  std::vector<std::string> remarks;
  return read(same_text(), build, remarks);
}

std::shared_ptr<const OpenedModel> OpenedModel::twin() const {
  OpenRequest request = same_text();
  request.words.model_options.ideal = {"all"};
  return std::make_shared<OpenedModel>(std::move(request));
}

void OpenedModel::refuse(const Error& error) const {
  if (error.category() != Error::Category::input && error.category() != Error::Category::plugin &&
      error.category() != Error::Category::numerical) {
    throw error;
  }
  Diagnostic diagnostic = as_diagnostic(error);
  if (error.location().file.empty()) diagnostic.location = {loaded_.document->file_name(), 0, 0};
  Diagnostics diagnostics = loaded_.diagnostics;
  diagnostics.add(std::move(diagnostic));
  throw Refusal(diagnostics, error.exit_code());
}

const AssembledModel& OpenedModel::assembled() const {
  if (const AssembledModel* known = assembled_) return *known;
  Diagnostics diagnostics;
  std::unique_ptr<const AssembledModel> found = assemble(diagnostics);
  const AssembledModel* first = nullptr;
  if (assembled_.compare_exchange_strong(first, found.get())) return *found.release();
  return *first;  // another thread was quicker
}

Json OpenedModel::facts() const {
  const Start& start = assembled().start;
  return facts_json(model(), start.facts, start.structure);
}

Json OpenedModel::start() const { return start_json(model(), assembled().start); }

Json OpenedModel::tree() const { return model_json(model()); }

std::string OpenedModel::with_record(const std::string& picture, const Model& model, Making making) const {
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) making.arguments.insert(making.arguments.end(), {option, value});
  };
  add("--set", request_.words.model_options.set);
  add("--ideal", request_.words.model_options.ideal);
  add("--plugin", request_.load.plugins);
  making.build = FREEPLAY_BUILD;
  return picture_with_record(picture, provenance_with_texts(model, making));
}

std::string OpenedModel::svg() const {
  const AssembledModel& assembled = this->assembled();
  return with_record(mechanism_svg(assembled.system, {assembled.start.state.q()}), model(),
                     {.made = "show", .command = "freeplay show", .arguments = {"--format", "svg"}, .build = {}});
}

}  // namespace freeplay
