// The past, played: so many seconds of the sea in one of ours.

const BEAT_MS = 200;
export const SPEEDS = [1, 10, 60, 600, 3600];

export class Playback {
  /** `go` is called with each next time [ms]; `ended` is called where the past ends. */
  constructor({ go, ended }) {
    Object.assign(this, { go, ended, speed: 600, timer: null });
  }

  get playing() {
    return this.timer !== null;
  }

  /** Play from a time; `end` answers where the past ends by then. */
  start(from, end) {
    this.stop();
    let at = from;
    this.timer = setInterval(() => {
      at += this.speed * BEAT_MS;
      if (at < end()) return this.go(at);
      this.stop();
      return this.ended();
    }, BEAT_MS);
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
  }
}
