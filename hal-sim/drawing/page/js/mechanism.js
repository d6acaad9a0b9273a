// The mechanism to scale: track, guides, platform, carriages. Used by the live page and by reports.
//
// A pose is { centre: [mm, mm], deg, pivots: [deg, deg, deg] }, a geometry { radius, start, end, disk }, all mm: the track, where
// the usable part of a guide starts and ends from the platform's centre, and the usable disk.

import { SIZES } from "./sizes.js";
import { colour } from "./theme.js";

const DEG = Math.PI / 180;
const GUIDES = SIZES.guidesDeg;
/** Names need room. */
const NAMES_PX_PER_MM = 1.1;

/** The place `along` mm and `left` mm from `from` in a direction. */
function off([x, y], deg, along, left = 0) {
  const [c, s] = [Math.cos(deg * DEG), Math.sin(deg * DEG)];
  return [x + along * c - left * s, y + along * s + left * c];
}

function trace(context, plane, points, close = false) {
  context.beginPath();
  for (const point of points) context.lineTo(...plane.pixel(point));
  if (close) context.closePath();
}

function circle(context, plane, centre, radius) {
  context.beginPath();
  context.arc(...plane.pixel(centre), radius * plane.scale, 0, 2 * Math.PI);
}

/** Track and usable disk. */
export function drawTrack(context, plane, geometry) {
  circle(context, plane, [0, 0], geometry.disk);
  context.fillStyle = colour("tint");
  context.fill();
  context.setLineDash([5, 4]);
  context.lineWidth = 1.2;
  context.strokeStyle = colour("faint");
  context.stroke();
  context.setLineDash([]);
  circle(context, plane, [0, 0], geometry.radius);
  context.lineWidth = Math.max(SIZES.trackLeastPx, SIZES.trackWidth * geometry.radius * plane.scale);
  context.strokeStyle = colour("steel");
  context.stroke();
  drawCross(context, plane, [0, 0], 5, colour("faint"));
}

/** A small cross of so many pixels. */
export function drawCross(context, plane, place, size, paint, width = 1.2) {
  const [x, y] = plane.pixel(place);
  context.strokeStyle = paint;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x - size, y);
  context.lineTo(x + size, y);
  context.moveTo(x, y - size);
  context.lineTo(x, y + size);
  context.stroke();
}

/** Guides, platform, arrow and carriages at a pose. */
export function drawMechanism(context, plane, geometry, pose) {
  GUIDES.forEach((offset, i) => drawGuide(context, plane, geometry, pose, pose.deg + offset, i));
  drawPlatform(context, plane, geometry, pose);
  GUIDES.forEach((offset, i) => drawCarriage(context, plane, geometry, pose, pose.deg + offset, i));
}

/** A rail: its usable part open in the pivot's colour, the rest a thin bar. */
function drawGuide(context, plane, geometry, pose, deg, index) {
  const width = Math.max(SIZES.guideLeastPx, SIZES.guideWidth * geometry.radius * plane.scale);
  const [start, end] = [off(pose.centre, deg, geometry.start), off(pose.centre, deg, geometry.end)];
  context.lineCap = "butt";
  trace(context, plane, [pose.centre, start]);
  context.strokeStyle = colour("ink");
  context.lineWidth = width / 3;
  context.stroke();
  trace(context, plane, [start, end]);
  context.strokeStyle = colour(`pivot-${index + 1}`);
  context.lineWidth = width;
  context.stroke();
  trace(context, plane, [off(start, deg, 1.5), off(end, deg, -1.5)]);
  context.strokeStyle = colour("panel");
  context.lineWidth = width - SIZES.guideWallsPx;
  context.stroke();
}

function corners(geometry, pose) {
  const out = geometry.start + SIZES.cornerBeyondStart * geometry.radius;
  return GUIDES.map((offset) => off(pose.centre, pose.deg + offset, out));
}

function drawPlatform(context, plane, geometry, pose) {
  trace(context, plane, corners(geometry, pose), true);
  context.lineJoin = "round";
  context.fillStyle = colour("platform");
  context.fill();
  context.strokeStyle = colour("ink");
  context.lineWidth = 2;
  context.stroke();
  drawArrow(context, plane, geometry, pose, colour("theta"));
  circle(context, plane, pose.centre, Math.max(SIZES.centreLeastPx / plane.scale, SIZES.centreRadius * geometry.radius));
  context.fillStyle = colour("centre");
  context.fill();
  context.strokeStyle = colour("panel");
  context.lineWidth = 1.5;
  context.stroke();
}

/** The platform's own x axis. */
function drawArrow(context, plane, geometry, pose, paint) {
  const at = (along, left) => off(pose.centre, pose.deg, along * geometry.radius, left * geometry.radius);
  trace(context, plane, [at(0, 0), at(SIZES.arrowShaft, 0)]);
  context.strokeStyle = paint;
  context.lineWidth = 3;
  context.stroke();
  trace(context, plane, [at(SIZES.arrowTip, 0), at(SIZES.arrowBack, SIZES.arrowHalfWidth), at(SIZES.arrowBack, -SIZES.arrowHalfWidth)], true);
  context.fillStyle = paint;
  context.fill();
  const [x, y] = plane.pixel(at(SIZES.arrowName, 0));
  write(context, "x′", x, y, paint, "bold 15px system-ui, sans-serif");
}

/** The carriage on the track, turned with its guide. */
function drawCarriage(context, plane, geometry, pose, deg, index) {
  const place = off([0, 0], pose.pivots[index], geometry.radius);
  const [long, wide] = [SIZES.carriageHalfLength * geometry.radius, SIZES.carriageHalfWidth * geometry.radius];
  trace(context, plane, [off(place, deg, long, wide), off(place, deg, -long, wide), off(place, deg, -long, -wide), off(place, deg, long, -wide)], true);
  context.fillStyle = colour(`pivot-${index + 1}`);
  context.fill();
  context.strokeStyle = colour("panel");
  context.lineWidth = 2;
  context.stroke();
  const size = Math.max(SIZES.numberLeastPx, SIZES.numberHeight * geometry.radius * plane.scale);
  write(context, String(index + 1), ...plane.pixel(place), colour("on-pivot"), `bold ${size}px system-ui, sans-serif`);
}

/** The platform's outline at a target. */
export function drawGhost(context, plane, geometry, pose, paint) {
  context.setLineDash([6, 4]);
  trace(context, plane, corners(geometry, pose), true);
  context.strokeStyle = paint;
  context.lineWidth = 2;
  context.stroke();
  context.setLineDash([]);
  drawCross(context, plane, pose.centre, 9, paint, 2);
}

/** Where the centre has been. */
export function drawTrail(context, plane, points) {
  if (points.length < 2) return;
  trace(context, plane, points);
  context.lineJoin = "round";
  context.strokeStyle = colour("centre");
  context.lineWidth = 1.8;
  context.stroke();
}

/** Text about a point, with a halo that keeps it readable on anything. */
export function write(context, text, x, y, paint, font = "13px system-ui, sans-serif", align = "center") {
  context.font = font;
  context.textAlign = align;
  context.textBaseline = "middle";
  if (paint !== colour("on-pivot")) {
    context.lineJoin = "round";
    context.lineWidth = 4;
    context.strokeStyle = colour("panel");
    context.strokeText(text, x, y);
  }
  context.fillStyle = paint;
  context.fillText(text, x, y);
}

/** Names of the parts, for whoever sees the mechanism for the first time. */
export function drawNames(context, plane, geometry, pose) {
  if (plane.scale < NAMES_PX_PER_MM) return;
  const { radius, disk, end } = geometry;
  const paint = colour("faint");
  const say = (text, place, align = "center") => {
    const [x, y] = plane.pixel(place);
    write(context, text, x, y, paint, undefined, align);
  };
  say("track", freeOfPivots(pose, radius * 1.15));
  say(`usable disk, ${(2 * disk).toFixed(0)} mm`, freeOfPivots(pose, disk * 0.75));
  const deg = pose.deg + GUIDES[0];
  say("guide", off(pose.centre, deg, 0.92 * end, 0.13 * radius));
  say("platform", off(pose.centre, pose.deg + 210, 0.36 * radius, -0.14 * radius));
}

/** A place at this distance from the centre that is as far from the carriages and guides as can be. */
function freeOfPivots(pose, distance) {
  const candidates = Array.from({ length: 36 }, (_, i) => i * 10 + 5);
  const gap = (deg) => Math.min(...pose.pivots.map((pivot) => Math.abs(((deg - pivot + 540) % 360 + 360) % 360 - 180)));
  const best = candidates.reduce((a, b) => (gap(b) > gap(a) ? b : a));
  return off([0, 0], best, distance);
}
