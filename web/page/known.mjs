// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What visitors know of a pair before it is matched: files, each { name, image } or null

import { inOrder, readImage, sizeOf } from './pair_files.mjs';

const get = id => document.getElementById(id);

const slots = {
    leftMask: { kind: 'mask', title: 'Mask of the left image', accept: 'image/*' },
    rightMask: { kind: 'mask', title: 'Mask of the right image', accept: 'image/*' },
    smallest: { kind: 'disparity', title: 'Smallest disparities', accept: '.pfm,.png', mayBeCoarse: true },
    largest: { kind: 'disparity', title: 'Largest disparities', accept: '.pfm,.png', mayBeCoarse: true },
    disparity: { kind: 'disparity', title: 'Disparities', accept: '.pfm,.png' },
    findings: { kind: 'findings', title: 'Findings', accept: '.yml,.yaml,.json,.xml' },
};

export const nothing = Object.fromEntries(Object.keys(slots).map(slot => [slot, null]));

// Which of the files are what is known, by their names: the others are a pair.
export function sortFiles(files) {
    const masks = inOrder(files.filter(({ name }) => /mask/i.test(name))),
        others = files.filter(file => !masks.includes(file)),
        smallest = others.find(({ name }) => /smallest/i.test(name)),
        largest = others.find(({ name }) => /largest/i.test(name)),
        disparity = others.find(file => /disparit/i.test(file.name) && file !== smallest && file !== largest),
        findings = others.find(({ name }) => /\.(ya?ml|json|xml)$/i.test(name));
    if (masks.length > 2)
        throw new Error(`These are ${masks.length} masks. Choose one for the left image and one for the right one.`);
    const [first, second] = masks,
        isRight = first && !second && /right|(?<![a-z])r(?![a-z])/i.test(first.name);
    const [leftMask, rightMask] = isRight ? [null, first] : [first, second];
    const all = Object.entries({ leftMask, rightMask, smallest, largest, disparity, findings }),
        known = Object.fromEntries(all.filter(([, file]) => file));
    return { known, pair: files.filter(file => !Object.values(known).includes(file)) };
}

// decode(file, kind) gives what the matcher takes.
export async function readKnown(files, decode) {
    const known = {};
    for (const [slot, file] of Object.entries(files))
        known[slot] = await readImage(file, chosen => decode(chosen, slots[slot].kind));
    return known;
}

// Throws what keeps it from being known of an image, if there is one.
export function checkKnown(known, image) {
    const { smallest, largest } = known;
    if (smallest && largest && sizeOf(smallest.image) !== sizeOf(largest.image))
        throw new Error(
            `${smallest.name} has ${sizeOf(smallest.image)} pixels, ${largest.name} ${sizeOf(largest.image)}. ` +
                'They must have one size.',
        );
    for (const [slot, chosen] of Object.entries(known).filter(([, chosen]) => chosen && image)) {
        const { width, height } = chosen.image,
            isCoarser = width <= image.width && height <= image.height;
        if (sizeOf(chosen.image) !== sizeOf(image) && !(slots[slot].mayBeCoarse && isCoarser))
            throw new Error(
                `${chosen.name} is for images of ${sizeOf(chosen.image)} pixels. These have ${sizeOf(image)}.`,
            );
    }
}

// Of the next pair: findings are those of the cameras.
export const keptFor = ({ findings }, image) =>
    findings && image && sizeOf(findings.image) === sizeOf(image) ? { ...nothing, findings } : nothing;

// No limits, of a map's size
const unlimited = map =>
    map && { width: map.width, height: map.height, data: new Float32Array(map.data.length).fill(NaN) };

// As the worker takes it
export const dataOf = ({ leftMask, rightMask, smallest, largest, disparity, findings }) => ({
    leftMask: leftMask?.image ?? null,
    rightMask: rightMask?.image ?? null,
    smallest: smallest?.image ?? unlimited(largest?.image) ?? null,
    largest: largest?.image ?? unlimited(smallest?.image) ?? null,
    disparity: disparity?.image ?? null,
    sigma: Number(get('known-sigma').value),
    findings: findings?.image.data ?? null,
});

// choose(slot, accept) and remove(slot) are what its buttons do.
export function addSlots(choose, remove) {
    for (const [slot, { title, accept }] of Object.entries(slots)) {
        const button = Object.assign(document.createElement('button'), { type: 'button', textContent: `${title}…` }),
            name = document.createElement('small'),
            cross = Object.assign(document.createElement('button'), { type: 'button', textContent: '×', hidden: true });
        cross.setAttribute('aria-label', `Without ${title.toLowerCase()}`);
        button.dataset.choose = cross.dataset.remove = name.dataset.known = slot;
        button.onclick = () => choose(slot, accept);
        cross.onclick = () => remove(slot);
        get(`known-${slot}`).prepend(button, name, cross);
    }
}

export function showKnown(known) {
    for (const [slot, chosen] of Object.entries(known)) {
        const parent = get(`known-${slot}`);
        parent.querySelector('small').textContent = chosen?.name ?? '';
        parent.querySelector('[data-remove]').hidden = !chosen;
    }
    const titles = Object.keys(known).filter(slot => known[slot]);
    get('known-summary').textContent = titles.length
        ? `: ${titles.map(slot => slots[slot].title.toLowerCase()).join(', ')}`
        : '';
}
