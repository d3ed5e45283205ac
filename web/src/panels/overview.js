// The past at a glance, painted behind the slider.

import { styled } from "../theme.js";
import { runs } from "./overview-rows.js";

/** Paint the largest load and the alarms over a window of time [ms] into a canvas. */
export function paintOverview(canvas, { times, shares, marks, start, end, gap }) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  Object.assign(canvas, { width: width * ratio, height: height * ratio });
  const ctx = canvas.getContext("2d");
  ctx.scale(ratio, ratio);
  const x = (t) => ((t - start) / (end - start)) * width;
  const top = Math.max(0.2, ...shares.map((share) => share ?? 0));
  const y = (share) => height - 2 - (share / top) * (height - 8);
  for (const run of runs(times, shares, gap)) {
    ctx.beginPath();
    run.forEach(([t, share]) => ctx.lineTo(x(1000 * t), y(share)));
    ctx.strokeStyle = styled("--mean");
    ctx.lineWidth = 1.3;
    ctx.stroke();
    ctx.lineTo(x(1000 * run.at(-1)[0]), height);
    ctx.lineTo(x(1000 * run[0][0]), height);
    ctx.fillStyle = styled("--band");
    ctx.fill();
  }
  for (const mark of marks) {
    ctx.fillStyle = styled(`--${mark.rank}`);
    ctx.fillRect(Math.round(x(mark.t)) - 1, 0, 2, height);
    ctx.beginPath();
    ctx.moveTo(x(mark.t) - 4, 0);
    ctx.lineTo(x(mark.t) + 4, 0);
    ctx.lineTo(x(mark.t), 6);
    ctx.fill();
  }
}
