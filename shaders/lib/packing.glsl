// Encodings of the G-buffer's integers.

// Node index and kind in one word: 0 is nothing. 30 bits of node, 2 of kind.
uint packId(uint node, uint kind) { return node << 2 | kind; }
uint nodeOfId(uint id) { return id >> 2; }
uint kindOfId(uint id) { return id & 3u; }
