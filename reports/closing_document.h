// The findings of a closing or a search as a document to pass on.
#pragma once

#include "document/document.h"
#include "reports/closing_record.h"

namespace softland {

/// Shows the finding in words, figures before and after, zoomable charts, the search, confirmations, the resolved scene and how
/// to reproduce it. Scene texts beyond 100 kB are cut, and the page says so.
[[nodiscard]] Document closing_document(const ClosingRecord& result);

}  // namespace softland
