// The report on a closing or a search as a document.
#pragma once

#include "document/document.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a document with the result in words, figures of merit of the plain step and the best waveform, zoomable charts, the
/// search, confirmations, the resolved scene, and the commands that reproduce the result. Scene texts beyond 100 kB are cut,
/// and the page says so.
[[nodiscard]] Document closing_document(const ClosingRecord& result);

}  // namespace softland
