// A house from above, on a canvas: rooms, furniture, walls, and the floor that nobody knows yet.
class MapGround {
  constructor(page, state) {
    this.page = page;
    this.state = state;
    this.canvas = make("canvas", { role: "img", "aria-label": "Map" });
    this.fog = document.createElement("canvas");
  }

  resize() {
    const box = this.canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.max(1, box.width), Math.max(1, box.height)];
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const { x, y, right, top } = this.page.box;
    const margin = 0.3;
    this.scale = Math.min(width / (right - x + 2 * margin), height / (top - y + 2 * margin));
    this.left = (width - this.scale * (right - x)) / 2 - this.scale * x;
    this.low = (height + this.scale * (top - y)) / 2 + this.scale * y;
    const context = this.canvas.getContext("2d", { willReadFrequently: true });
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    return context;
  }

  to(x, y) {
    return [this.left + this.scale * x, this.low - this.scale * y];
  }

  from(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left - this.left) / this.scale, (this.low - event.clientY + box.top) / this.scale];
  }

  trace(context, points, close = true) {
    context.beginPath();
    points.forEach(([x, y], place) => (place ? context.lineTo(...this.to(x, y)) : context.moveTo(...this.to(x, y))));
    if (close) context.closePath();
  }

  drawRooms(context) {
    for (const room of this.page.house.rooms) {
      this.trace(context, room.polygon);
      context.fillStyle = room.colour;
      context.fill();
    }
  }

  drawFurniture(context) {
    context.lineWidth = 1;
    for (const thing of this.page.house.furniture) {
      this.trace(context, thing.polygon);
      context.fillStyle = "rgba(255,255,255,0.82)";
      context.fill();
      context.strokeStyle = "#b5afa3";
      context.stroke();
    }
  }

  drawFog(context, step) {
    const focus = this.episode.robots[this.state.focusIn(this.episode)];
    const first = focus ? focus.floor : this.episode.any;
    if (!first) return;
    const [x, y, cell, columns, rows] = this.episode.grid;
    this.fog.width = columns;
    this.fog.height = rows;
    const sheet = this.fog.getContext("2d");
    const image = sheet.createImageData(columns, rows);
    for (let column = 0; column < columns; column++) {
      for (let row = 0; row < rows; row++) {
        if (first[column * rows + row] <= step) continue;
        const at = 4 * ((rows - 1 - row) * columns + column);
        image.data[at] = 44;
        image.data[at + 1] = 52;
        image.data[at + 2] = 66;
        image.data[at + 3] = 92;
      }
    }
    sheet.putImageData(image, 0, 0);
    context.save();
    context.beginPath();
    for (const room of this.page.house.rooms) {
      room.polygon.forEach((corner, place) => (place ? context.lineTo(...this.to(...corner)) : context.moveTo(...this.to(...corner))));
      context.closePath();
    }
    context.clip();
    context.imageSmoothingEnabled = false;
    const [left, top] = this.to(x, y + rows * cell);
    context.drawImage(this.fog, left, top, columns * cell * this.scale, rows * cell * this.scale);
    context.restore();
  }

  drawWalls(context) {
    context.lineCap = "square";
    for (const wall of this.page.house.walls) this.line(context, wall, this.page.house.wall, Math.max(2, 0.09 * this.scale));
    context.lineCap = "butt";
    for (const hole of this.page.house.openings) {
      this.line(context, hole.line, hole.colour, Math.max(2, (hole.passable ? 0.12 : 0.06) * this.scale));
    }
  }

  line(context, points, colour, width) {
    this.trace(context, points, false);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
  }

  drawNames(context) {
    context.textAlign = "center";
    context.textBaseline = "middle";
    if (this.scale > 46) {
      context.font = "10px system-ui, sans-serif";
      context.fillStyle = "#7d776b";
      for (const thing of this.page.house.furniture) {
        if (thing.named) thing.name.split(" ").forEach((word, place, words) => {
          const [x, y] = this.to(...thing.at);
          context.fillText(word, x, y + 10.5 * (place - (words.length - 1) / 2));
        });
      }
    }
    const size = clamp(0.28 * this.scale, 9, 14);
    context.font = `600 ${size}px system-ui, sans-serif`;
    for (const room of this.page.house.rooms) {
      outlined(context, room.name.toUpperCase(), ...this.to(...room.middle), "#4b4841", "rgba(255,255,255,0.75)", 3);
    }
  }
}

function outlined(context, text, x, y, colour, rim, width) {
  context.lineJoin = "round";
  context.lineWidth = width;
  context.strokeStyle = rim;
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}
