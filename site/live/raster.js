// Draws many thin lines: for tens of thousands of edges, each frame, that is faster than a canvas' own paths.

// The part of a line in a box, by Liang and Barsky; null for none, also for NaN.
function partInside(x0, y0, x1, y1, {left, top, right, bottom}) {
  const dx = x1 - x0, dy = y1 - y0;
  let from = 0, to = 1;
  for (const [step, room] of [[-dx, x0 - left], [dx, right - x0], [-dy, y0 - top], [dy, bottom - y0]]) {
    if (step < 0) from = Math.max(from, room / step);
    else if (step > 0) to = Math.min(to, room / step);
    else if (!(room >= 0)) return null;
  }
  if (!(from <= to)) return null;
  const within = (least, value, most) => Math.min(Math.max(value, least), most);
  return [
    within(left, x0 + from * dx, right), within(top, y0 + from * dy, bottom),
    within(left, x0 + to * dx, right), within(top, y0 + to * dy, bottom),
  ];
}

export class Raster {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  /** Begins a picture. area: the only part that is drawn anew, if it is given and the size is as before. */
  begin(width, height, area) {
    const isNew = this.width !== width || this.height !== height;
    if (isNew) {
      this.canvas.width = this.width = width;
      this.canvas.height = this.height = height;
      this.image = this.context.createImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
      // How much of each pixel is covered, with a row and a column more, to which lines at the border write.
      this.stride = width + 1;
      this.cover = new Uint8Array(this.stride * (height + 1));
    }
    const within = ({left, top, right, bottom}, margin) => ({
      left: Math.max(0, Math.floor(left) - margin), top: Math.max(0, Math.floor(top) - margin),
      right: Math.min(width - 1, Math.ceil(right) + margin), bottom: Math.min(height - 1, Math.ceil(bottom) + margin),
    });
    const drawn = area && !isNew ? area : {left: 0, top: 0, right: width, bottom: height};
    this.box = within(drawn, 0);
    // Lines beside the box cover a part of its pixels.
    this.reach = within(drawn, 2);
    for (let y = this.box.top; y <= this.box.bottom; y++) {
      this.pixels.fill(0, y * width + this.box.left, y * width + this.box.right + 1);
    }
  }

  line(x0, y0, x1, y1) {
    const {left, top, right, bottom} = this.reach;
    if (x0 >= left && x0 <= right && x1 >= left && x1 <= right && y0 >= top && y0 <= bottom && y1 >= top &&
        y1 <= bottom) {
      this.insideLine(x0, y0, x1, y1);
    } else if (!((x0 < left && x1 < left) || (x0 > right && x1 > right) || (y0 < top && y1 < top) ||
        (y0 > bottom && y1 > bottom))) {
      const part = partInside(x0, y0, x1, y1, this.reach);
      if (part) this.insideLine(...part);
    }
  }

  // One pixel per step along the longer side, shared with its neighbour by the distance to both. In 1/65536 of a pixel.
  insideLine(x0, y0, x1, y1) {
    const {cover, stride} = this;
    const dx = x1 - x0, dy = y1 - y0;
    const isSteep = Math.abs(dy) > Math.abs(dx);
    const along = isSteep ? stride : 1, across = isSteep ? 1 : stride;
    const isForward = isSteep ? dy >= 0 : dx >= 0;
    const u = isForward ? (isSteep ? y0 : x0) : isSteep ? y1 : x1;
    const v = isForward ? (isSteep ? x0 : y0) : isSteep ? x1 : y1;
    const end = isForward ? (isSteep ? y1 : x1) : isSteep ? y0 : x0;
    const slope = dx === 0 && dy === 0 ? 0 : isSteep ? dx / dy : dy / dx;
    const first = (u + 0.5) | 0, last = (end + 0.5) | 0, step = (slope * 65536) | 0;
    // Rounded ends can lie beside the line's, by less than a pixel.
    const most = ((isSteep ? this.width : this.height) - 1) << 16;
    let at = ((v + slope * (first - u)) * 65536) | 0;
    for (let k = first, place = first * along; k <= last; k++, place += along, at += step) {
      const inside = at < 0 ? 0 : at > most ? most : at;
      const pixel = place + (inside >> 16) * across, part = (inside >> 8) & 255;
      if (cover[pixel] < 255 - part) cover[pixel] = 255 - part;
      if (cover[pixel + across] < part) cover[pixel + across] = part;
    }
  }

  dot(x, y) {
    const {left, top, right, bottom} = this.reach;
    if (!(x >= left && y >= top && x <= right && y <= bottom)) return;
    const {cover, stride} = this;
    const pixel = Math.round(y) * stride + Math.round(x);
    cover[pixel] = cover[pixel + 1] = cover[pixel + stride] = cover[pixel + stride + 1] = 255;
  }

  /** Gives all lines since the last call a colour, 0xbbggrr, and the strongest of them this opacity. */
  ink(colour, opacity = 1) {
    const {width, stride, cover, pixels} = this, {left, top, right, bottom} = this.box;
    const inks = Uint32Array.from({length: 256}, (_, part) => ((Math.round(part * opacity) << 24) | colour) >>> 0);
    for (let y = top; y <= bottom; y++) {
      for (let x = left, pixel = y * width + x, place = y * stride + x; x <= right; x++, pixel++, place++) {
        const part = cover[place];
        if (part !== 0 && (part > 100 || pixels[pixel] === 0)) pixels[pixel] = inks[part];
      }
    }
    cover.fill(0);
  }

  end() {
    const {left, top, right, bottom} = this.box;
    this.context.putImageData(this.image, 0, 0, left, top, right - left + 1, bottom - top + 1);
  }
}
