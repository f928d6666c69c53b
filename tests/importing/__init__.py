"""Robot files: imported, held against independent readers, derived."""
