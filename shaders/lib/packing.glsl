// Encodings of the G-buffer's integers.

// What a pixel shows and its kind in one word: 0 is nothing. 30 bits of the node of a mesh, of the instance's row of an
// SDF object, whose node stands there; 2 of kind.
uint packId(uint number, uint kind) { return number << 2 | kind; }
uint numberOfId(uint id) { return id >> 2; }
uint kindOfId(uint id) { return id & 3u; }

// Where the ray of an SDF object ended: brick of the level it was traced in, counted from 1, and the level.
uint packBrick(uint brick, uint level) { return brick | level << 24; }
uint levelOfBrick(uint code) { return code >> 24; }
