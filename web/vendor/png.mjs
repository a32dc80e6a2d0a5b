// PNG of 8 and 16 bits: what browsers decode has 8
export { decode, encode, hasPngSignature } from 'fast-png';
