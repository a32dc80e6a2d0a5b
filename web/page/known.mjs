// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What visitors know of a pair before it is matched: files, each { name, image } or null

import { inOrder, readImage, sizeOf } from './pair_files.mjs';

const get = id => document.getElementById(id);

const slots = {
    leftMask: { kind: 'mask', title: 'Mask of the left image', accept: 'image/*' },
    rightMask: { kind: 'mask', title: 'Mask of the right image', accept: 'image/*' },
    disparity: { kind: 'disparity', title: 'Disparities', accept: '.pfm,.png' },
    findings: { kind: 'findings', title: 'Findings', accept: '.yml,.yaml,.json,.xml' },
};

export const nothing = Object.fromEntries(Object.keys(slots).map(slot => [slot, null]));

// Which of the files are what is known, by their names: the others are a pair.
export function sortFiles(files) {
    const masks = inOrder(files.filter(({ name }) => /mask/i.test(name))),
        disparity = files.find(({ name }) => /disparit/i.test(name) && !/mask/i.test(name)),
        findings = files.find(({ name }) => /\.(ya?ml|json|xml)$/i.test(name));
    if (masks.length > 2)
        throw new Error(`These are ${masks.length} masks. Choose one for the left image and one for the right one.`);
    const [first, second] = masks,
        isRight = first && !second && /right|(?<![a-z])r(?![a-z])/i.test(first.name);
    const known = { leftMask: isRight ? null : first, rightMask: isRight ? first : second, disparity, findings };
    return {
        known: Object.fromEntries(Object.entries(known).filter(([, file]) => file)),
        pair: files.filter(file => !masks.includes(file) && file !== disparity && file !== findings),
    };
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
    for (const chosen of Object.values(known))
        if (chosen && image && sizeOf(chosen.image) !== sizeOf(image))
            throw new Error(
                `${chosen.name} is for images of ${sizeOf(chosen.image)} pixels. These have ${sizeOf(image)}.`,
            );
}

// Of the next pair: findings are those of the cameras.
export const keptFor = ({ findings }, image) =>
    findings && image && sizeOf(findings.image) === sizeOf(image) ? { ...nothing, findings } : nothing;

// As the worker takes it
export const dataOf = ({ leftMask, rightMask, disparity, findings }) => ({
    leftMask: leftMask?.image ?? null,
    rightMask: rightMask?.image ?? null,
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
