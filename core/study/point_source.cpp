#include "study/point_source.h"

namespace freeplay {

PointSource point_source(const StudyFile& file) {
  PointSource source;
  for (const StudyModel& model : file.models()) source.models.push_back(model.document.get());
  for (const PlannedSetting& setting : file.set()) source.set.push_back({setting.target, setting.value.text});
  source.reducers = file.section().reducers;
  source.analysis = file.section().analysis;
  source.chained = file.section().warm_start.has_value();
  return source;
}

}  // namespace freeplay
