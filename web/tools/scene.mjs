// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The pair that the page has built in: a still life by a small ray tracer, with the true disparities.
//     node scene.mjs FOLDER   writes left.png, right.png, and truth.png, 16 bit, 256 times the disparity

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { encode } from 'fast-png';

export const width = 640,
    height = 480;
export const focal = 620,
    baseline = 0.19; // in pixels; in the unit of the scene
const samples = 2; // per pixel, in each direction
const shadowRays = 5;
const noise = 1.2; // standard deviation of the grey levels

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const normalize = a => scale(a, 1 / Math.sqrt(dot(a, a)));
const mix = (a, b, t) => a.map((value, i) => value + (b[i] - value) * t);
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const smooth = (from, to, value) => {
    const t = clamp((value - from) / (to - from), 0, 1);
    return t * t * (3 - 2 * t);
};
const color = hex => [16, 8, 0].map(shift => (((hex >> shift) & 255) / 255) ** 2.2); // linear light

function hash(x, y, z) {
    let h = Math.imul(x, 374761393) ^ Math.imul(y, 668265263) ^ Math.imul(z, 1274126177);
    h = Math.imul(h ^ (h >>> 13), 1103515245);
    h = Math.imul(h ^ (h >>> 16), 2246822519);
    return ((h ^ (h >>> 15)) >>> 0) / 4294967296;
}

// From 0 to 1, smooth between whole numbers
function valueNoise(x, y, z) {
    const xi = Math.floor(x),
        yi = Math.floor(y),
        zi = Math.floor(z);
    const fx = x - xi,
        fy = y - yi,
        fz = z - zi;
    const u = fx * fx * (3 - 2 * fx),
        v = fy * fy * (3 - 2 * fy),
        w = fz * fz * (3 - 2 * fz);
    const row = (b, c) => (1 - u) * hash(xi, yi + b, zi + c) + u * hash(xi + 1, yi + b, zi + c);
    return (1 - w) * ((1 - v) * row(0, 0) + v * row(1, 0)) + w * ((1 - v) * row(0, 1) + v * row(1, 1));
}

function fractalNoise(x, y, z, octaves) {
    let sum = 0,
        weight = 0.5,
        total = 0;
    for (let i = 0; i < octaves; i++) {
        sum += weight * valueNoise(x, y, z + 17 * i);
        total += weight;
        x *= 2.03;
        y *= 2.03;
        z *= 2.03;
        weight /= 2;
    }
    return sum / total;
}

// Surfaces: colours of a point, in coordinates of the thing

function planks(p) {
    const plank = Math.floor(p[0] / 0.62),
        offset = 2.4 * hash(plank, 3, 7);
    const part = Math.floor((p[2] + offset) / 2.4);
    const grain = fractalNoise(26 * p[0], plank * 9.1, 1.6 * p[2] + part * 5, 5);
    const rings = 0.5 + 0.5 * Math.sin(34 * p[0] + 9 * fractalNoise(2 * p[0], plank, 0.7 * p[2] + part, 3));
    const tone = 0.75 + 0.5 * hash(plank, part, 11);
    const gap = Math.min(
        Math.abs(p[0] / 0.62 - Math.round(p[0] / 0.62)) * 0.62,
        Math.abs((p[2] + offset) / 2.4 - Math.round((p[2] + offset) / 2.4)) * 2.4,
    );
    const wood = mix(color(0x7a4a28), color(0xd29a62), 0.65 * grain + 0.35 * rings);
    return scale(wood, tone * (0.35 + 0.65 * smooth(0.004, 0.016, gap)));
}

function plaster(p) {
    const coarse = fractalNoise(1.1 * p[0], 1.1 * p[1], 4, 3),
        fine = fractalNoise(9 * p[0], 9 * p[1], 2, 5);
    const base = scale(mix(color(0x587f86), color(0x84a9a6), coarse), 0.62 + 0.75 * fine);
    return base;
}

function painting(p) {
    // in a frame, 1.9 x 1.3
    const x = Math.abs(p[0]) / 0.95,
        y = Math.abs(p[1]) / 0.65;
    if (x > 0.9 || y > 0.86) return scale(color(0x3a2516), 0.7 + 0.7 * fractalNoise(30 * p[0], 30 * p[1], 1, 3));
    if (x > 0.76 || y > 0.68) return scale(color(0xf2ead8), 0.88 + 0.2 * fractalNoise(24 * p[0], 24 * p[1], 6, 3));
    const hills = 0.25 * fractalNoise(2.4 * p[0] + 4, 1, 1, 4) - 0.2;
    const sun = Math.sqrt((p[0] - 0.32) ** 2 + (p[1] - 0.17) ** 2);
    let paint = mix(color(0xe8a25e), color(0x3c6e98), smooth(-0.15, 0.42, p[1]));
    if (sun < 0.11) paint = color(0xfbe3a8);
    if (p[1] < hills + 0.1) paint = mix(color(0x2f5d62), color(0x5b8a72), smooth(hills - 0.1, hills + 0.1, p[1]));
    if (p[1] < 0.8 * hills - 0.06 + 0.08 * Math.sin(5 * p[0])) paint = color(0x8f5b3a);
    return scale(paint, 0.6 + 0.75 * fractalNoise(17 * p[0], 40 * p[1], 8, 4));
}

function ball(p) {
    // a toy ball with panels
    const angle = (Math.atan2(p[2], p[0]) / Math.PI) * 3,
        band = Math.floor(angle + 6);
    const seam = Math.abs(angle - Math.round(angle));
    const panel = [color(0xd8492f), color(0xf3e6cf), color(0x20618c)][band % 3];
    const wear = 0.72 + 0.5 * fractalNoise(14 * p[0], 14 * p[1], 14 * p[2], 4);
    return scale(panel, wear * (0.4 + 0.6 * smooth(0.01, 0.035, seam)));
}

function marble(p) {
    const vein = Math.abs(Math.sin(6 * p[0] + 5 * p[1] + 7 * fractalNoise(3 * p[0], 3 * p[1], 3 * p[2], 5)));
    const dust = 0.8 + 0.35 * fractalNoise(26 * p[0], 26 * p[1], 26 * p[2], 3);
    return scale(mix(color(0x2c3b33), color(0xc9d6c3), smooth(0.05, 0.75, vein)), dust);
}

function crate(p, normal) {
    const [u, v] = Math.abs(normal[1]) > 0.5 ? [p[0], p[2]] : Math.abs(normal[0]) > 0.5 ? [p[2], p[1]] : [p[0], p[1]];
    const board = Math.floor(v / 0.19);
    const gap = Math.abs(v / 0.19 - Math.round(v / 0.19)) * 0.19;
    const grain = fractalNoise(3 * u + 7 * board, 24 * v, board, 5);
    return scale(
        mix(color(0x8f6a3c), color(0xe3c08a), grain),
        (0.8 + 0.35 * hash(board, 5, 5)) * (0.3 + 0.7 * smooth(0.003, 0.012, gap)),
    );
}

function book(hex) {
    return (p, normal) => {
        const paper = Math.abs(normal[1]) < 0.5 && normal[2] > -0.9 && Math.abs(p[1]) < 0.055;
        const cloth = fractalNoise(34 * p[0], 34 * p[1], 34 * p[2], 3);
        if (paper) return scale(color(0xf0e6d0), 0.65 + 0.45 * valueNoise(4 * p[0], 130 * p[1], 4 * p[2]));
        const line = Math.abs(normal[2]) > 0.9 && Math.abs(Math.abs(p[0]) - 0.42) < 0.025;
        return scale(line ? color(0xe0c070) : color(hex), 0.65 + 0.6 * cloth);
    };
}

function pot(p) {
    const stripe = Math.sin(30 * p[1]),
        zigzag = Math.abs((((((Math.atan2(p[2], p[0]) * 8) / Math.PI) % 1) + 1) % 1) - 0.5);
    const isBand = p[1] > -0.1 && p[1] < 0.2;
    const glaze = isBand
        ? 0.3 * (zigzag - 0.25) + 0.05 > Math.abs(p[1] - 0.05) - 0.06
            ? color(0xf2e3c6)
            : color(0x27485e)
        : stripe > 0.9
          ? color(0x8a4a2e)
          : color(0xc07a4f);
    return scale(glaze, 0.7 + 0.5 * fractalNoise(20 * p[0], 20 * p[1], 20 * p[2], 4));
}

const stick = p =>
    scale(
        Math.sin(16 * p[1]) > 0 ? color(0xf0ead6) : color(0xb23a2e),
        0.75 + 0.4 * fractalNoise(30 * p[0], 30 * p[1], 30 * p[2], 3),
    );

// Things: intersect() gives the nearest distance beyond `least` and what is needed for normal and colour.

const turned = (v, angle) => {
    const c = Math.cos(angle),
        s = Math.sin(angle);
    return [c * v[0] + s * v[2], v[1], -s * v[0] + c * v[2]];
};

function plane(point, normal, surface) {
    return {
        surface,
        intersect(origin, direction, least) {
            const t = dot(subtract(point, origin), normal) / dot(direction, normal);
            return t > least ? { t, point: subtract(add(origin, scale(direction, t)), point), normal } : null;
        },
    };
}

function sphere(center, radius, angle, surface) {
    return {
        surface,
        intersect(origin, direction, least) {
            const from = subtract(origin, center),
                b = dot(from, direction),
                a = dot(direction, direction);
            const discriminant = b * b - a * (dot(from, from) - radius * radius);
            if (discriminant < 0) return null;
            const t = (-b - Math.sqrt(discriminant)) / a;
            if (t <= least) return null;
            const point = add(from, scale(direction, t));
            return { t, point: turned(point, angle), normal: scale(point, 1 / radius) };
        },
    };
}

function box(center, half, angle, surface) {
    return {
        surface,
        intersect(origin, direction, least) {
            const o = turned(subtract(origin, center), angle),
                d = turned(direction, angle);
            let near = -Infinity,
                far = Infinity,
                axis = 0;
            for (let i = 0; i < 3; i++) {
                const a = (-half[i] - o[i]) / d[i],
                    b = (half[i] - o[i]) / d[i];
                if (Math.min(a, b) > near) [near, axis] = [Math.min(a, b), i];
                far = Math.min(far, Math.max(a, b));
            }
            if (near > far || near <= least) return null;
            const normal = [0, 0, 0];
            normal[axis] = -Math.sign(d[axis]);
            return { t: near, point: add(o, scale(d, near)), localNormal: normal, normal: turned(normal, -angle) };
        },
    };
}

const straight = () => 1;

function cylinder(center, radius, half, surface, profile = straight) {
    // upright, open at the ends
    return {
        surface,
        intersect(origin, direction, least) {
            const o = subtract(origin, center);
            // By steps, as the radius may change with the height
            const a = direction[0] ** 2 + direction[2] ** 2,
                b = o[0] * direction[0] + o[2] * direction[2];
            const c = o[0] ** 2 + o[2] ** 2 - (1.25 * radius) ** 2,
                discriminant = b * b - a * c;
            if (discriminant < 0) return null;
            const middleHeight = Math.abs(o[1] - (direction[1] * b) / a);
            if (middleHeight > half + (Math.abs(direction[1]) * Math.sqrt(discriminant)) / a) return null;
            const root = Math.sqrt(discriminant),
                outside = t => {
                    const x = o[0] + t * direction[0],
                        z = o[2] + t * direction[2];
                    return Math.sqrt(x * x + z * z) - radius * profile((o[1] + t * direction[1]) / half);
                };
            const steps = profile === straight ? 12 : 48;
            let before = (-b - root) / a;
            for (let i = 1; i <= steps; i++) {
                let after = (-b - root + (2 * root * i) / steps) / a;
                if (outside(after) < 0) {
                    for (let j = 0; j < 12; j++) {
                        const middle = (before + after) / 2;
                        if (outside(middle) < 0) after = middle;
                        else before = middle;
                    }
                    const point = add(o, scale(direction, after));
                    if (Math.abs(point[1]) <= half && after > least) {
                        const slope =
                            ((profile((point[1] + 0.001) / half) - profile((point[1] - 0.001) / half)) * radius) /
                            0.002;
                        return {
                            t: after,
                            point,
                            normal: normalize([point[0], -slope * Math.sqrt(point[0] ** 2 + point[2] ** 2), point[2]]),
                        };
                    }
                }
                before = after;
            }
            return null;
        },
    };
}

// x to the right, y up, z away from the camera, which is at the origin
const floor = -1.15;
const things = [
    plane([0, floor, 0], [0, 1, 0], planks),
    plane([0, 0, 8.2], [0, 0, -1], plaster),
    box([-1.75, 1.55, 8.1], [0.95, 0.65, 0.06], 0, painting),
    box([2.5, floor + 0.75, 6.4], [0.75, 0.75, 0.6], 0.35, crate),
    sphere([2.35, floor + 1.5 + 0.42, 6.3], 0.42, 0.5, marble),
    box([-2.3, floor + 0.5, 5.6], [0.62, 0.5, 0.5], -0.3, crate),
    cylinder([-2.25, floor + 1.0 + 0.55, 5.6], 0.36, 0.55, pot, y => 0.8 + 0.42 * Math.sin(1.9 * (y + 0.75))),
    sphere([0.1, floor + 0.62, 4.9], 0.62, -0.5, ball),
    box([-1.0, floor + 0.09, 3.45], [0.56, 0.09, 0.4], 0.25, book(0x2d5a4a)),
    box([-1.04, floor + 0.27, 3.48], [0.5, 0.09, 0.37], 0.05, book(0x9c3b2e)),
    sphere([-1.02, floor + 0.36 + 0.2, 3.45], 0.2, 0, marble),
    box([1.25, floor + 0.22, 3.3], [0.3, 0.22, 0.3], -0.55, crate),
    cylinder([0.78, 0.2, 3.9], 0.035, 1.35, stick),
];
const lights = [{ to: normalize([-0.55, 0.95, -0.6]), spread: 0.09, strength: 1.0 }];

function nearest(origin, direction, least) {
    let hit = null;
    for (const thing of things) {
        const found = thing.intersect(origin, direction, least);
        if (found && (!hit || found.t < hit.t)) {
            hit = found;
            hit.thing = thing;
        }
    }
    return hit;
}

// The light does not depend on the camera: both images show the same colours.
function shade(point, hit) {
    const base = hit.thing.surface(hit.point, hit.localNormal ?? hit.normal);
    const [light] = lights;
    let lit = 0;
    for (let i = 0; i < shadowRays; i++) {
        const jitter = [0, 1, 2].map(axis => hash(i, axis, 99) - 0.5);
        const direction = normalize(add(light.to, scale(jitter, 2 * light.spread)));
        const facing = dot(hit.normal, direction);
        if (facing > 0 && !things.some(thing => thing.intersect(point, direction, 1e-3))) lit += facing / shadowRays;
    }
    const sky = 0.5 + 0.5 * hit.normal[1];
    // What stands on the floor darkens it around.
    const contact = 0.55 + 0.45 * smooth(0, 0.5, point[1] - floor);
    const ambient = mix([0.3, 0.27, 0.24], [0.42, 0.46, 0.52], sky).map(
        value => value * (hit.normal[1] > 0.9 ? 1 : contact),
    );
    return base.map((value, c) => value * (ambient[c] + [1.18, 1.08, 0.92][c] * lit));
}

function render(cameraX) {
    const image = new Float64Array(3 * width * height);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++)
            for (let s = 0; s < samples * samples; s++) {
                const u = ((s % samples) + 0.5) / samples,
                    v = (Math.floor(s / samples) + 0.5) / samples;
                const direction = [(x + u - width / 2) / focal, -(y + v - height / 2) / focal - 0.04, 1];
                const origin = [cameraX, 0.15, 0],
                    hit = nearest(origin, direction, 1e-3);
                const light = hit ? shade(add(origin, scale(direction, hit.t)), hit) : [0, 0, 0];
                for (let c = 0; c < 3; c++) image[3 * (y * width + x) + c] += light[c] / samples ** 2;
            }
    return image;
}

// As a camera sees it, with noise of its own
function develop(light, seed) {
    return Uint8Array.from(light, (value, i) => {
        let sum = -6; // of twelve even numbers: nearly Gaussian
        for (let k = 0; k < 12; k++) sum += hash(i, k, seed);
        return clamp(Math.round(255 * clamp(1.05 * value, 0, 1) ** (1 / 2.2) + noise * sum), 0, 255);
    });
}

// The depth along z is what counts: direction z is 1.
function truth() {
    const map = new Uint16Array(width * height);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const direction = [(x + 0.5 - width / 2) / focal, -(y + 0.5 - height / 2) / focal - 0.04, 1];
            const hit = nearest([0, 0.15, 0], direction, 1e-3);
            map[y * width + x] = hit ? Math.round((256 * focal * baseline) / hit.t) : 0;
        }
    return map;
}

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const write = (name, image) => writeFileSync(join(folder, name), encode({ width, height, ...image }));
write('left.png', { data: develop(render(0), 1), channels: 3 });
write('right.png', { data: develop(render(baseline), 2), channels: 3 });
write('truth.png', { data: truth(), channels: 1, depth: 16 });
